// groundloop validate and groundloop list: scenarios, without running them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/cli/scenario_check.h"
#include "bench/runner/frame_export.h"
#include "bench/runner/preview.h"
#include "bench/runner/scenario_export.h"
#include "bench/verdict/verdict.h"
#include "sim/scenario/scenario.h"

namespace groundloop::bench {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const std::vector<Problem>& problems) {
  ordered_json list = ordered_json::array();
  for (const Problem& p : problems) {
    list.push_back(
        {{"file", p.file}, {"line", p.line}, {"key", p.key}, {"value", p.value}, {"wanted", p.wanted}});
  }
  return list;
}

void print_problems(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) fmt::print(stderr, "{}\n", problem.text());
}

int validate(const std::vector<std::string>& files, bool json) {
  Outcome outcome = Outcome::kPass;
  ordered_json answer = ordered_json::array();
  for (const std::string& file : files) {
    const std::vector<Problem> problems = problems_of_scenario(file);
    if (!problems.empty()) outcome = Outcome::kBadInput;
    if (json) {
      answer.push_back({{"file", file}, {"valid", problems.empty()}, {"problems", as_json(problems)}});
    } else if (problems.empty()) {
      fmt::print("{}: valid\n", file);
    } else {
      print_problems(problems);
    }
  }
  if (json) fmt::print("{}\n", answer.dump(2));
  return exit_code(outcome);
}

std::vector<std::string> scenario_files(const std::string& dir) {
  std::error_code error;
  std::vector<std::string> files;
  for (std::filesystem::directory_iterator it(dir, error), end; !error && it != end; it.increment(error)) {
    if (it->is_regular_file() && it->path().extension() == ".yaml") files.push_back(it->path().string());
  }
  if (error) throw InputError(Problem{dir, 0, "", error.message(), "a folder of scenario files"});
  std::sort(files.begin(), files.end());
  return files;
}

int list(const std::string& dir, bool json) {
  Outcome outcome = Outcome::kPass;
  std::vector<sim::Scenario> scenarios;
  for (const std::string& file : scenario_files(dir)) {
    try {
      scenarios.push_back(sim::load_scenario(file));
    } catch (const InputError& error) {
      print_problems(error.problems());
      outcome = Outcome::kBadInput;
    }
  }
  if (json) {
    ordered_json answer = ordered_json::array();
    for (const sim::Scenario& s : scenarios) {
      answer.push_back({{"name", s.name}, {"file", s.file}, {"summary", s.summary}});
    }
    fmt::print("{}\n", answer.dump(2));
    return exit_code(outcome);
  }
  size_t width = 0;
  for (const sim::Scenario& s : scenarios) width = std::max(width, s.name.size());
  for (const sim::Scenario& s : scenarios) fmt::print("{:<{}}  {}\n", s.name, width, s.summary);
  return exit_code(outcome);
}

}  // namespace

void add_validate_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("validate", "check scenarios: keys, models and the planned path");
  const auto files = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("scenario", *files, "scenario files")->required()->type_name("FILE");
  command->add_flag("--json", *json, "print JSON");
  command->callback([=, &action] { action = [=] { return validate(*files, *json); }; });
}

void add_preview_command(CLI::App& app, CommandAction& action) {
  CLI::App* command =
      app.add_subcommand("preview", "picture of a scenario: scene and planned path from above");
  const auto file = std::make_shared<std::string>();
  const auto out = std::make_shared<std::string>();
  command->add_option("scenario", *file, "scenario file")->required()->type_name("FILE");
  command->add_option("--out", *out, "picture to write (default: NAME.png)")->type_name("PNG");
  const auto folder = std::make_shared<std::string>();
  command
      ->add_option("--export", *folder,
                   "write what is generated into a folder, to be edited, in place of a picture")
      ->type_name("DIR");
  const auto set = std::make_shared<std::vector<std::string>>();
  add_set(*command, *set, "set a key of the scenario; repeatable");
  command->callback([=, &action] {
    action = [=] {
      const sim::Scenario scenario = sim::load_scenario(*file, overrides_of(*set));
      if (folder->empty()) {
        fmt::print("{}\n", preview(scenario, *out));
      } else {
        for (const std::string& written : export_scenario(scenario, *folder)) fmt::print("{}\n", written);
      }
      return exit_code(Outcome::kPass);
    };
  });
}

void add_frame_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("frame", "one pair of a scenario made again, with its exact truth");
  const auto file = std::make_shared<std::string>();
  const auto frame = std::make_shared<int64_t>(0);
  const auto seed = std::make_shared<std::optional<uint64_t>>();
  const auto set = std::make_shared<std::vector<std::string>>();
  const auto out = std::make_shared<std::string>();
  command->add_option("scenario", *file, "scenario file, also that of a run folder")
      ->required()
      ->type_name("FILE");
  command->add_option("frame", *frame, "index of the pair, as in frames.csv")->required()->type_name("N");
  command->add_option("--seed", *seed, "in place of the scenario's")->type_name("S");
  command->add_option("--out", *out, "folder to write to")->required()->type_name("DIR");
  add_set(*command, *set, "set a key of the scenario; repeatable");
  add_renderer(*command);
  command->callback([=, &action] {
    action = [=] {
      sim::Scenario scenario = sim::load_scenario(*file, overrides_of(*set));
      scenario.seed = seed->value_or(scenario.seed);
      for (const std::string& written : export_frame(scenario, *frame, *out)) fmt::print("{}\n", written);
      return exit_code(Outcome::kPass);
    };
  });
}

void add_list_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("list", "scenarios of a folder, with their summaries");
  const auto dir = std::make_shared<std::string>("scenarios");
  const auto json = std::make_shared<bool>(false);
  command->add_option("dir", *dir, "folder")->capture_default_str()->type_name("DIR");
  command->add_flag("--json", *json, "print JSON");
  command->callback([=, &action] { action = [=] { return list(*dir, *json); }; });
}

}  // namespace groundloop::bench
