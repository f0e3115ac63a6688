#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sim/scenario/scenario.h"
#include "slam/types/config.h"

namespace groundloop::sim {

/// A folder of its own for every test, and files in it.
class Scratch : public ::testing::Test {
 protected:
  Scratch() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("groundloop_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~Scratch() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return path(name);
  }

  Scenario scenario(const std::string& world, const std::string& robot) const {
    Scenario scenario;
    scenario.world.file = write("world.xml", world);
    scenario.robot.model = write("robot.xml", robot);
    return scenario;
  }

  /// The problems that a call reports; none when it succeeds.
  template <class Call>
  static std::vector<Problem> problems_of(const Call& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.problems();
    }
    return {};
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace groundloop::sim
