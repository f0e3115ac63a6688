// Documents say what is: links resolve, code names exist, every key is explained.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
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
  for (auto it = std::sregex_iterator(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it) {
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
    EXPECT_THAT(text, testing::HasSubstr("`" + key + "`")) << document << " does not explain " << key;
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

TEST(Documents, ExplainEveryOptionOfTheCore) {
  expect_explained(keys_of(slam::SlamOptions{}), "docs/slam-options.md");
}

}  // namespace
}  // namespace groundloop
