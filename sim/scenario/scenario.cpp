#include "sim/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

namespace groundloop::sim {
namespace {

constexpr const char* kCommandLine = "--set";

int line_of(const YAML::Node& node) {
  return node.IsDefined() && !node.Mark().is_null() ? node.Mark().line + 1 : 0;
}

/// A key given twice: yaml-cpp would silently take the first.
void report_repeated_keys(const YAML::Node& node, const std::string& path, const std::string& file,
                          std::vector<Problem>& problems) {
  if (node.IsSequence()) {
    for (size_t i = 0; i < node.size(); ++i) {
      report_repeated_keys(node[i], fmt::format("{}[{}]", path, i), file, problems);
    }
  }
  if (!node.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>("");
    const std::string key = path.empty() ? name : path + "." + name;
    if (!seen.insert(name).second) {
      problems.push_back({file, line_of(entry.first), key, "key given twice", "every key once"});
    }
    report_repeated_keys(entry.second, key, file, problems);
  }
}

template <class T>
void remember_lines(const YAML::Node& list, std::vector<T>& items) {
  for (size_t i = 0; i < items.size(); ++i) items[i].line = line_of(list[i]);
}

/// Lines that messages need after loading.
void remember_lines(const YAML::Node& root, Scenario& scenario) {
  if (const YAML::Node start = root["robot"]["start"]; start.IsDefined()) {
    scenario.robot.start.line = line_of(start);
  }
  const YAML::Node segments = root["plan"]["segments"];
  for (size_t i = 0; i < scenario.plan.segments.size(); ++i) {
    scenario.plan.segments[i].line = line_of(segments[i]);
  }
  remember_lines(root["plan"]["poses"], scenario.plan.poses);
  if (scenario.plan.path) scenario.plan.path->line = line_of(root["plan"]["path"]);
  remember_lines(root["faults"], scenario.faults);
  remember_lines(root["people"], scenario.people);
  remember_lines(root["moves"], scenario.moves);
  remember_lines(root["lights"], scenario.lights);
  const YAML::Node slam = root["slam"];
  if (!slam.IsDefined()) return;
  scenario.slam.preset_line = slam["preset"].IsDefined() ? line_of(slam["preset"]) : 0;
  if (!slam["set"].IsDefined()) return;
  for (const auto& entry : slam["set"]) {
    scenario.slam.set_lines[entry.first.as<std::string>()] = line_of(entry.first);
  }
}

bool starts_with(const std::string& text, const std::string& head) { return text.rfind(head, 0) == 0; }

/// Scalars stay as typed; lists and maps ([..], {..}) are parsed.
YAML::Node value_node(const std::string& value) {
  const bool nested = !value.empty() && (value.front() == '[' || value.front() == '{');
  return nested ? YAML::Load(value) : YAML::Node(value);
}

/// A metric's name holds dots of its own: expect.trajectory.ate_rmse_m.max is {expect: {<metric>: {max:
/// ..}}}.
YAML::Node expectation_node(const std::string& key, const YAML::Node& value) {
  YAML::Node expect(YAML::NodeType::Map), root(YAML::NodeType::Map);
  const size_t dot = std::min(key.rfind('.'), key.size());
  const std::string last = key.substr(dot);
  if (last == ".min" || last == ".max") {
    expect[key.substr(0, dot)][last.substr(1)] = value;
  } else {
    expect[key] = value;
  }
  root["expect"] = expect;
  return root;
}

void set_slam_option(Scenario& scenario, const std::string& option, const std::string& value) {
  scenario.slam.set[option] = value;
  scenario.slam.set_lines[option] = 0;
}

void apply_override(const Override& override_, Scenario& scenario, std::vector<Problem>& problems) {
  const std::string& key = override_.key;
  if (key == "slam.preset") scenario.slam.preset_line = 0;
  if (key != "slam.preset" && key != "slam.set") {
    for (const char* prefix : {"slam.set.", "slam."}) {
      if (starts_with(key, prefix)) {
        return set_slam_option(scenario, key.substr(std::string(prefix).size()), override_.value);
      }
    }
  }
  const size_t first_own = problems.size();
  try {
    YAML::Node value = value_node(override_.value);
    YAML::Node root =
        starts_with(key, "expect.") ? expectation_node(key.substr(7), value) : nested_node(key, value);
    ConfigReader reader(root, kCommandLine, "", &problems);
    reader.set_overlay(true);
    scenario.visit(reader);
    reader.finish();
  } catch (const YAML::Exception& e) {
    problems.push_back({kCommandLine, 0, key, override_.value, "valid YAML: " + e.msg});
  }
  for (size_t i = first_own; i < problems.size(); ++i) problems[i].line = 0;
}

/// Makes a path absolute, relative to the scenario's folder; it must be an existing file (or folder).
void resolve(std::string& path, const std::string& key, const YAML::Node& node, const Scenario& scenario,
             const std::vector<Override>& overrides, const std::string& wanted,
             std::vector<Problem>& problems, bool is_folder = false) {
  namespace fs = std::filesystem;
  if (path.empty()) return;  // reported as missing already
  const fs::path folder = fs::absolute(scenario.file).parent_path();
  const fs::path resolved = (folder / path).lexically_normal();
  std::error_code error;
  if (is_folder ? !fs::is_directory(resolved, error) : !fs::is_regular_file(resolved, error)) {
    const bool typed =
        std::any_of(overrides.begin(), overrides.end(), [&](const Override& o) { return o.key == key; });
    const std::string file = typed ? kCommandLine : scenario.file;
    problems.push_back({file, typed ? 0 : line_of(node), key, path,
                        fmt::format("{} that exists (looked for {})", wanted, resolved.string())});
  }
  path = resolved.string();
}

void resolve_world(Scenario& scenario, const YAML::Node& node, const std::vector<Override>& overrides,
                   std::vector<Problem>& problems) {
  if (scenario.world.generate) {
    resolve(scenario.world.generate->textures, "world.generate.textures", node, scenario, overrides,
            "a folder of the house's textures (models/generated, made by the build)", problems, true);
  }
  const bool bare = node.IsDefined() && node.IsScalar();
  resolve(scenario.world.file, bare ? "world" : "world.file", bare || !node.IsMap() ? node : node["file"],
          scenario, overrides, "an MJCF file", problems);
}

/// What only a robot on wheels can do, or suffer.
void check_for_arm(const Scenario& scenario, ConfigReader& reader) {
  if (scenario.plan.feedback != Feedback::kPlan) {
    reader.problem("plan", "feedback other than plan", "an arm, which follows its plan");
  }
  if (!scenario.people.empty()) reader.problem("people", "given", "none about an arm");
  if (!scenario.moves.empty()) reader.problem("moves", "given", "none about an arm");
  const bool of_wheels = std::any_of(scenario.faults.begin(), scenario.faults.end(), [](const Fault& f) {
    return f.wheel_slip || f.kidnap || f.encoder || f.trigger_offset || f.knock;
  });
  if (of_wheels) {
    reader.problem("faults", "wheel_slip, kidnap, encoder, trigger_offset or knock",
                   "faults that one camera on an arm can suffer: those of images and their transport");
  }
}

/// In the file's order, the command line's last; what both a file and an override complain of once.
std::vector<Problem> tidied(std::vector<Problem> problems) {
  const auto place = [](const Problem& problem) {
    return std::pair(problem.file == kCommandLine, problem.line);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return place(a) < place(b); });
  std::vector<Problem> kept;
  for (Problem& problem : problems) {
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const Problem& other) {
      return other.key == problem.key && other.wanted == problem.wanted && other.value == problem.value;
    });
    if (!seen) kept.push_back(std::move(problem));
  }
  return kept;
}

}  // namespace

void WorldChoice::check(ConfigReader& reader) const {
  if (file.empty() != generate.has_value()) reader.problem("", "exactly one of: file, generate");
}

void Segment::check(ConfigReader& reader) const {
  const int members = straight_m.has_value() + arc.has_value() + stop_s.has_value() + look.has_value();
  if (members != 1) reader.problem("", "exactly one of: straight_m, arc, stop_s, look");
}

void Plan::check(ConfigReader& reader) const {
  if (generate && !segments.empty()) reader.problem("generate", "either segments or generate, not both");
  if (is_for_arm()) {
    if (!poses.empty() && path) reader.problem("path", "either poses or path, not both");
    if (generate || !segments.empty()) {
      reader.problem(poses.empty() ? "path" : "poses", "given beside a drive",
                     "either segments, which a robot drives, or poses or path, which an arm follows");
    }
  } else if (!generate && segments.empty()) {
    if (reader.has("segments")) {
      reader.problem("segments", "at least one segment");
    } else {
      reader.problem("segments", "missing", "a list, or `generate` in its place");
    }
  }
}

void Expectation::check(ConfigReader& reader) const {
  if (!min && !max) reader.problem("", "bounds: min and/or max");
  if (min && max && *min > *max) reader.problem("", fmt::format("min ({}) not above max ({})", *min, *max));
}

void Expectations::check(ConfigReader& reader) const {
  if (outcome != "tracked" && outcome != "lost") reader.problem("outcome", "one of: tracked, lost");
}

void Scenario::check(ConfigReader& reader) const {
  if (plan.is_for_arm()) check_for_arm(*this, reader);
  if (scale != 1 && !plan.is_for_arm()) {
    reader.problem("scale", "1, unless an arm carries the camera (plan.poses or plan.path)");
  }
  const bool kidnapped =
      std::any_of(faults.begin(), faults.end(), [](const Fault& f) { return f.kidnap.has_value(); });
  if (kidnapped && plan.feedback == Feedback::kSlam) {
    reader.problem(
        "faults", "kidnap with feedback: slam",
        "no kidnapping while SLAM steers: once it knows the place, it would drive straight back to its path");
  }
  if (reader.has("format") && format != 1) reader.problem("format", "1, the only format this version reads");
  const auto usable = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  };
  if (reader.has("name") &&
      (!std::all_of(name.begin(), name.end(), usable) || name.empty() || name.front() == '.')) {
    reader.problem("name", "letters, digits, dots, dashes and underscores: it names the run folder");
  }
}

Scenario load_scenario(const std::string& file, const std::vector<Override>& overrides) {
  YAML::Node root = load_yaml_file(file);
  std::vector<Problem> problems;
  Scenario scenario;
  scenario.file = file;

  report_repeated_keys(root, "", file, problems);
  read_config(root, file, scenario, problems);
  if (!root.IsMap()) throw InputError(problems.front());  // the rest would say that every key is missing
  if (problems.empty()) remember_lines(root, scenario);

  for (const Override& override_ : overrides) apply_override(override_, scenario, problems);
  if (!overrides.empty() && problems.empty()) {  // what they broke between keys of the whole
    ConfigReader reader(root, file, "", &problems);
    scenario.check(reader);
  }

  resolve_world(scenario, root["world"], overrides, problems);
  resolve(scenario.robot.model, "robot.model", root["robot"]["model"], scenario, overrides, "an MJCF file",
          problems);
  resolve(scenario.head.model, "head.model", root["head"]["model"], scenario, overrides, "a head's YAML file",
          problems);
  for (size_t i = 0; i < scenario.people.size(); ++i) {
    resolve(scenario.people[i].model, fmt::format("people[{}].model", i), root["people"][i]["model"],
            scenario, overrides, "an MJCF file", problems);
  }
  if (scenario.plan.generate && scenario.robot.start.line != 0) {
    problems.push_back(
        {file, scenario.robot.start.line, "robot.start", "given", "no start: it is chosen by plan.generate"});
  }
  if (!problems.empty()) throw InputError(tidied(std::move(problems)));
  return scenario;
}

std::string to_yaml(const Scenario& scenario) { return groundloop::to_yaml<Scenario>(scenario); }

}  // namespace groundloop::sim
