// What may be in the tree: no paths of one machine, no large files, runnable scripts, sorted package lists.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/house/tree.h"

namespace fs = std::filesystem;

namespace groundloop {
namespace {

bool is_text(const std::string& content) { return content.find('\0') == std::string::npos; }

TEST(Files, HoldNoPathOfOneMachine) {
  // written in pieces, so that this file does not name them itself
  const std::vector<std::string> places = {
      "/wo"
      "rk/",
      "/tm"
      "p/",
      "/ho"
      "me/"};
  for (const fs::path& file : tree_files()) {
    const std::string content = tree_text(file);
    if (!is_text(content)) continue;
    for (const std::string& place : places) {
      EXPECT_EQ(content.find(place), std::string::npos) << file << " names " << place;
    }
  }
}

TEST(Files, AreSmall) {
  for (const fs::path& file : tree_files()) {
    EXPECT_LE(fs::file_size(fs::path(GROUNDLOOP_ROOT) / file), 512U * 1024U) << file;
  }
}

TEST(Scripts, HaveRunBitsAndStopAtErrors) {
  const fs::path root = GROUNDLOOP_ROOT;
  int scripts = 0;
  for (const fs::path& file : tree_files()) {
    const std::string content = tree_text(file);
    if (!content.starts_with("#!")) continue;
    ++scripts;
    const auto run_bits = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    EXPECT_EQ(fs::status(root / file).permissions() & run_bits, run_bits) << file << " cannot be run";
    EXPECT_THAT(content, testing::HasSubstr("\nset -euo pipefail\n")) << file;
  }
  EXPECT_GE(scripts, 7) << "setup, build, test, demo, lint, bare and the server's run";
}

TEST(Packages, AreSortedAndNamedOnce) {
  const std::regex package("[a-z0-9][a-z0-9+.-]+");
  for (const char* list : {"ci/packages.txt", "ci/packages-lint.txt"}) {
    std::vector<std::string> names;
    std::istringstream lines(tree_text(list));
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("#")) continue;
      EXPECT_TRUE(std::regex_match(line, package)) << list << ": " << line;
      names.push_back(line);
    }
    EXPECT_FALSE(names.empty()) << list;
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end())) << list;
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << list;
  }
}

TEST(TemporaryFolder, IsThisProcessOwn) {
  const std::string mine = fs::temp_directory_path().string();
  EXPECT_THAT(mine, testing::HasSubstr("groundloop_test_"));
  EXPECT_TRUE(fs::is_empty(mine));
  EXPECT_EQ(fs::path(testing::TempDir()).parent_path(), mine);
}

TEST(Server, CallsTheScriptsThatPeopleRun) {
  const std::string run = tree_text(".ci/run");
  EXPECT_THAT(run, testing::HasSubstr("\nci/test"));
  EXPECT_THAT(run, testing::HasSubstr("\nci/demo"));
}

}  // namespace
}  // namespace groundloop
