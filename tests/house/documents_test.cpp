// Documents say what is: links resolve, code names exist, every key is explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "sim/head/head.h"
#include "sim/scenario/metric_names.h"
#include "sim/scenario/scenario.h"
#include "slam/pipeline/options.h"
#include "tests/house/tree.h"

namespace fs = std::filesystem;

namespace groundloop {
namespace {

std::vector<fs::path> documents() {
  std::vector<fs::path> found;
  for (const fs::path& file : tree_files()) {
    if (file.extension() == ".md") found.push_back(file);
  }
  return found;
}

std::vector<std::string> matches_of(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), pattern); it != std::sregex_iterator();
       ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

TEST(Documents, LinksResolve) {
  const std::regex link(R"(\]\(([^)#\s]+)(#[^)]*)?\))");
  const fs::path root = GROUNDLOOP_ROOT;
  int links = 0;
  for (const fs::path& document : documents()) {
    for (const std::string& target : matches_of(tree_text(document), link)) {
      if (target.starts_with("http")) continue;
      ++links;
      EXPECT_TRUE(fs::exists(root / document.parent_path() / target)) << document << " links to " << target;
    }
  }
  EXPECT_GT(links, 10);
}

TEST(Documents, NameOnlyFilesThatExist) {
  const std::regex name(R"(`((?:slam|sim|bench|ci|docs|models|scenarios|tests|cmake)/[A-Za-z0-9_./-]+)`)");
  for (const fs::path& document : documents()) {
    if (document == "CHANGELOG.md") continue;  // tells of files of the past as well
    for (const std::string& file : matches_of(tree_text(document), name)) {
      EXPECT_TRUE(fs::exists(fs::path(GROUNDLOOP_ROOT) / file)) << document << " names " << file;
    }
  }
}

TEST(Sources, NameOnlyDocumentsThatExist) {
  const std::regex name(R"(\b([A-Za-z0-9_][A-Za-z0-9_/-]*\.md)\b)");
  const fs::path root = GROUNDLOOP_ROOT;
  for (const char* folder : {"slam", "sim", "bench", "tests", "models"}) {
    for (const fs::path& file : tree_files(folder, {".h", ".cpp"})) {
      for (const std::string& document : matches_of(tree_text(file), name)) {
        EXPECT_TRUE(fs::exists(root / document) || fs::exists(root / "docs" / document))
            << file << " names " << document;
      }
    }
  }
}

/// Rows of docs/paper-to-code.md are `| section | what | [file](../file) | names in backticks | ... |`.
TEST(Documents, PaperToCodeNamesWhatTheFilesHold) {
  const std::regex row(R"(^\|[^|]+\|[^|]+\| \[`?([^\]`]+)`?\]\([^)]+\) \|([^|]+)\|)");
  const std::regex name("`([A-Za-z0-9_:]+)`");
  std::istringstream lines(tree_text("docs/paper-to-code.md"));
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, row)) continue;
    ++rows;
    const std::string code = tree_text(match[1].str());
    const auto names = matches_of(match[2].str(), name);
    EXPECT_FALSE(names.empty()) << line;
    for (const std::string& wanted : names) {
      EXPECT_THAT(code, testing::HasSubstr(wanted)) << match[1] << " does not hold " << wanted;
    }
  }
  EXPECT_GE(rows, 15);
}

/// Collects the keys of a configuration struct, nested maps and list items included.
class KeyList {
 public:
  std::set<std::string> keys;

  template <class T>
  void operator()(const char* key, T& value, const Field& = {}) {
    keys.insert(key);
    descend(value);
  }

 private:
  template <class T>
  void descend(T& value) {
    if constexpr (config_detail::IsOptional<T>::value || config_detail::IsVector<T>::value) {
      typename T::value_type inner{};
      descend(inner);
    } else if constexpr (config_detail::IsStringMap<T>::value) {
      typename T::mapped_type inner{};
      descend(inner);
    } else if constexpr (requires { value.visit(*this); }) {
      value.visit(*this);
    }
  }
};

template <class... T>
std::set<std::string> keys_of(T... structs) {
  KeyList list;
  (structs.visit(list), ...);
  return list.keys;
}

void expect_explained(const std::set<std::string>& keys, const char* document) {
  const std::string text = tree_text(document);
  for (const std::string& key : keys) {
    EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << document << " does not explain " << key;
  }
}

TEST(Documents, ExplainEveryKeyOfAScenario) {
  const std::set<std::string> metrics(sim::kMetricNames.begin(), sim::kMetricNames.end());
  std::set<std::string> keys;
  for (const std::string& key : keys_of(sim::Scenario{})) {
    if (!metrics.contains(key)) keys.insert(key);
  }
  EXPECT_GT(keys.size(), 25U);
  expect_explained(keys, "docs/scenario-format.md");
}

TEST(Documents, ExplainEveryMetric) {
  expect_explained({sim::kMetricNames.begin(), sim::kMetricNames.end()}, "docs/metrics.md");
}

TEST(Documents, ExplainEveryKeyOfAHead) {
  expect_explained(keys_of(sim::HeadModel{}), "docs/scenario-format.md");
}

/// In docs/scenarios.md a scenario has a heading and the picture that `groundloop preview` drew of it, a
/// fault has a row that begins with a link to its file.
TEST(Documents, ShowEveryScenario) {
  const std::string text = tree_text("docs/scenarios.md");
  const auto expect_said = [&text](const std::string& wanted) {
    EXPECT_NE(text.find(wanted), std::string::npos) << "docs/scenarios.md does not hold " << wanted;
  };
  size_t scenarios = 0, faults = 0;
  for (const fs::path& file : tree_files("scenarios", {".yaml"})) {
    const std::string name = file.stem().string();
    if (file.parent_path() == "scenarios/faults") {
      ++faults;
      expect_said("\n| [" + name + "](../" + file.generic_string() + ") |");
      continue;
    }
    ++scenarios;
    const std::string picture = "pictures/scenarios/" + name + ".png";
    EXPECT_TRUE(fs::exists(fs::path(GROUNDLOOP_ROOT) / "docs" / picture)) << picture << " is missing";
    expect_said("\n### " + name + "\n");
    expect_said("](" + picture + ")");
  }
  EXPECT_GT(scenarios, 10U);
  EXPECT_GT(faults, 10U);
  EXPECT_EQ(tree_files("docs/pictures/scenarios", {".png"}).size(), scenarios) << "a picture of no scenario";
}

TEST(Scenarios, SayWhatTheyAreAndWhatMustComeOut) {
  for (const fs::path& file : tree_files("scenarios", {".yaml"})) {
    const YAML::Node scenario = YAML::Load(tree_text(file));
    const YAML::Node summary = scenario["summary"], expect = scenario["expect"];
    EXPECT_TRUE(summary.IsDefined() && summary.IsScalar() && !summary.Scalar().empty())
        << file << " has no summary";
    EXPECT_TRUE(expect.IsDefined() && expect.IsMap() && expect.size() > 0) << file << " expects nothing";
  }
}

/// Dotted name to value, lists as "a, b".
void flatten(const YAML::Node& node, const std::string& path, std::map<std::string, std::string>& values) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      flatten(entry.second, (path.empty() ? "" : path + ".") + entry.first.as<std::string>(), values);
    }
  } else if (node.IsSequence()) {
    std::string& list = values[path];
    for (const YAML::Node& item : node) list += (list.empty() ? "" : ", ") + item.Scalar();
  } else {
    values[path] = node.Scalar();
  }
}

std::map<std::string, std::string> values_of(const slam::SlamOptions& options) {
  std::map<std::string, std::string> values;
  flatten(YAML::Load(to_yaml(options)), "", values);
  return values;
}

/// 2e-5 and 0.00002 say the same.
bool same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  double number_a = 0, number_b = 0;
  std::istringstream text_a(a), text_b(b);
  return text_a >> number_a && text_b >> number_b && text_a.eof() && text_b.eof() && number_a == number_b;
}

bool same_list(const std::string& a, const std::string& b) {
  std::istringstream items_a(a), items_b(b);
  std::string item_a, item_b;
  while (std::getline(items_a, item_a, ',')) {
    if (!std::getline(items_b, item_b, ',') || !same_value(item_a, item_b)) return false;
  }
  return !std::getline(items_b, item_b, ',');
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Rows are `| group | option | default | paper | meaning |`; an empty group is that of the row above, an
/// empty value of preset paper is that of default.
TEST(Documents, TellEveryOptionOfTheCoreWithItsValues) {
  const auto standard = values_of(slam::preset("default")), paper = values_of(slam::preset("paper"));
  std::set<std::string> told;
  std::istringstream lines(tree_text("docs/slam-options.md"));
  std::string group;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
    if (cells.size() != 6 || cells[2] == "option" || cells[2].starts_with("-")) continue;
    if (!cells[1].empty()) group = cells[1];
    const std::string name = (group.empty() ? "" : group + ".") + cells[2];
    told.insert(name);
    if (!standard.contains(name)) {
      ADD_FAILURE() << name << " is no option";
      continue;
    }
    EXPECT_TRUE(same_list(cells[3], standard.at(name))) << name << " is " << standard.at(name);
    EXPECT_TRUE(same_list(cells[4].empty() ? cells[3] : cells[4], paper.at(name)))
        << name << " of preset paper is " << paper.at(name);
  }
  for (const auto& [name, value] : standard) EXPECT_TRUE(told.contains(name)) << name << " is missing";
}

}  // namespace
}  // namespace groundloop
