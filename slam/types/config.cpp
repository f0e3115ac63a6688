#include "slam/types/config.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace groundloop {
namespace {

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + problem.text();
  return text;
}

/// Levenshtein distance, for "did you mean".
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string shown(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsScalar()) return node.Scalar();
  YAML::Emitter out;
  out << YAML::Flow << node;
  std::string text = out.c_str();
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

}  // namespace

std::string Problem::text() const {
  std::string where = file;
  if (line > 0) where += fmt::format(":{}", line);
  std::string text = where;
  if (!key.empty()) text += (text.empty() ? "" : ": ") + key;
  if (!value.empty()) text += ": " + value;
  if (!wanted.empty()) text += ": wanted " + wanted;
  return text;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

ConfigReader::ConfigReader(const YAML::Node& node, std::string file, std::string path,
                           std::vector<Problem>* problems, std::optional<int> line)
    : node_(node), file_(std::move(file)), path_(std::move(path)), problems_(problems), line_(line) {
  if (!node_.IsMap()) {
    problems_->push_back({file_, line_of(node_), path_, shown(node_), "a map of keys and values"});
  }
}

std::string ConfigReader::path_of(const std::string& key) const {
  if (path_.empty()) return key;
  return key.empty() ? path_ : path_ + "." + key;
}

int ConfigReader::line_of(const YAML::Node& node) const {
  if (line_) return *line_;
  if (!node.IsDefined() || node.Mark().is_null()) return 0;
  return node.Mark().line + 1;
}

bool ConfigReader::has(const std::string& key) const {
  return node_.IsMap() && node_[key].IsDefined() && !node_[key].IsNull();
}

void ConfigReader::problem(const std::string& key, const std::string& wanted) {
  problem(key, key.empty() ? shown(node_) : shown(node_[key]), wanted);
}

void ConfigReader::problem(const std::string& key, const std::string& value, const std::string& wanted) {
  const YAML::Node child = !key.empty() && has(key) ? node_[key] : node_;
  problems_->push_back({file_, line_of(child), path_of(key), value, wanted});
}

void ConfigReader::wrong(const YAML::Node& child, const std::string& key, const std::string& wanted) {
  problems_->push_back({file_, line_of(child), path_of(key), shown(child), wanted});
}

std::string ConfigReader::describe_range(const std::string& what, const Field& field) {
  const bool low = std::isfinite(field.min), high = std::isfinite(field.max);
  if (low && high) return fmt::format("{} from {} to {}", what, field.min, field.max);
  if (low) return fmt::format("{} of at least {}", what, field.min);
  if (high) return fmt::format("{} of at most {}", what, field.max);
  return what;
}

void ConfigReader::finish() {
  if (!node_.IsMap()) return;
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>("");
    if (known_.count(key) != 0) continue;
    std::string all, nearest;
    size_t best = 4;
    for (const std::string& candidate : known_) {
      all += (all.empty() ? "" : ", ") + candidate;
      const size_t distance = edit_distance(key, candidate);
      if (distance < best) best = distance, nearest = candidate;
    }
    const std::string wanted =
        nearest.empty() ? "one of: " + all : fmt::format("one of: {} (did you mean {}?)", all, nearest);
    problems_->push_back({file_, line_of(entry.first), path_of(key), "unknown key", wanted});
  }
}

YAML::Node load_yaml_file(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(Problem{file, 0, "", "no such file", "a YAML file that can be read"});
  }
  std::ifstream in(file);
  if (!in) throw InputError(Problem{file, 0, "", "cannot be opened", "a YAML file that can be read"});
  std::stringstream text;
  text << in.rdbuf();
  try {
    return YAML::Load(text.str());
  } catch (const YAML::Exception& e) {
    throw InputError(Problem{file, e.mark.line + 1, "", e.msg, "valid YAML"});
  }
}

YAML::Node nested_node(const std::string& dotted_key, const YAML::Node& value) {
  const size_t dot = dotted_key.find('.');
  YAML::Node node(YAML::NodeType::Map);
  if (dot == std::string::npos) {
    node[dotted_key] = value;
  } else {
    node[dotted_key.substr(0, dot)] = nested_node(dotted_key.substr(dot + 1), value);
  }
  return node;
}

}  // namespace groundloop
