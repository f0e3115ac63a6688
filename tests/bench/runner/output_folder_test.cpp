#include "bench/runner/output_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "slam/types/config.h"

namespace groundloop::bench {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(parent_); }
  void TearDown() override { fs::remove_all(parent_); }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string read(const fs::path& file) {
    std::string text;
    std::getline(std::ifstream(file), text);
    return text;
  }
  size_t entries() const { return static_cast<size_t>(std::distance(fs::directory_iterator(parent_), {})); }

  const fs::path parent_ = fs::temp_directory_path() / "groundloop_output_folder";
  const std::string destination_ = (parent_ / "run").string();
};

TEST_F(OutputFolderTest, AppearsOnlyWhenPublished) {
  OutputFolder out(destination_);
  write(out.file("run.json"), "new");
  EXPECT_FALSE(fs::exists(destination_));
  out.publish();
  EXPECT_EQ(read(destination_ + "/run.json"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFolderTest, LeavesNothingWhenGivenUp) {
  { OutputFolder out(destination_); }
  EXPECT_EQ(entries(), 0U);
}

TEST_F(OutputFolderTest, KeepsTheOlderRunUntilTheNewIsComplete) {
  fs::create_directories(destination_);
  write(destination_ + "/run.json", "old");
  { OutputFolder out(destination_); }
  EXPECT_EQ(read(destination_ + "/run.json"), "old");
  OutputFolder out(destination_);
  write(out.file("run.json"), "new");
  EXPECT_EQ(read(destination_ + "/run.json"), "old");
  out.publish();
  EXPECT_EQ(read(destination_ + "/run.json"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFolderTest, RefusesToReplaceWhatIsNotARun) {
  fs::create_directories(destination_);
  write(destination_ + "/thesis.tex", "precious");
  try {
    OutputFolder out(destination_);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              "--out: " + destination_ +
                  ": holds something that is not a run: wanted a new folder, or an older run to replace");
  }
  EXPECT_EQ(read(destination_ + "/thesis.tex"), "precious");
}

}  // namespace
}  // namespace groundloop::bench
