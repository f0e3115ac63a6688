// Runs the program itself: exit codes, messages, answers.
#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <algorithm>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/metrics/trajectory_file.h"
#include "tests/bench/metrics/poses.h"
#include "tests/bench/metrics/test_folder.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Answer {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs `groundloop ARGUMENTS` in the source folder, through a shell.
Answer groundloop(const std::string& arguments) {
  const TestFolder folder;
  const std::string command = std::string("'" GROUNDLOOP_PROGRAM "' ") + arguments + " >'" +
                              folder.path("out") + "' 2>'" + folder.path("err") + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder.path("out")),
          text_of(folder.path("err"))};
}

/// Trajectories in files of the test's own (the program's output has its folder removed after each call).
class Eval : public testing::Test {
 protected:
  Eval() : truth_(folder_ + "truth.tum"), estimate_(folder_ + "estimate.tum") {
    std::filesystem::create_directories(folder_);
    slam::Trajectory poses = circle(40, 3);
    write_tum(truth_, poses);
    for (size_t i = 0; i < poses.size(); ++i) {
      poses[i].T =
          moved(5, 0, 0) * turned(30, {0, 0, 1}) * moved(0, 0, i % 2 == 0 ? 0.01 : -0.01) * poses[i].T;
    }
    write_tum(estimate_, poses);
  }
  ~Eval() override { std::filesystem::remove_all(folder_); }

  std::string files() const { return "--truth " + truth_ + " --estimate " + estimate_ + " "; }

  std::string folder_ = testing::TempDir() + "/groundloop_eval_" +
                        testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
  std::string truth_, estimate_;
};

TEST(Program, HelpNamesTheCommandsAndExitCodes) {
  const Answer answer = groundloop("--help");
  EXPECT_EQ(answer.exit_code, 0);
  for (const char* command : {"run", "replay", "eval", "validate", "list"}) {
    EXPECT_THAT(answer.out, HasSubstr(std::string("\n  ") + command + " "));
  }
  EXPECT_THAT(answer.out,
              HasSubstr("Exit codes: 0 pass, 1 the SLAM fell short, 2 bad input, 3 internal error"));
  EXPECT_EQ(answer.err, "");
}

TEST(Program, EveryCommandHasHelp) {
  for (const std::string command : {"run", "replay", "eval", "validate", "list"}) {
    const Answer answer = groundloop(command + " --help");
    EXPECT_EQ(answer.exit_code, 0);
    EXPECT_THAT(answer.out, HasSubstr("groundloop " + command));
  }
}

TEST(Program, TellsItsVersion) {
  EXPECT_EQ(groundloop("--version").out, "groundloop " GROUNDLOOP_VERSION "\n");
}

TEST(Program, WithoutArgumentsShowsHelpAsAnError) {
  const Answer answer = groundloop("");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("Usage: groundloop"));
}

TEST(Program, RefusesUnknownCommandsAndOptions) {
  const Answer command = groundloop("rnu");
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_THAT(command.err, StartsWith("unknown command: rnu: wanted one of: run, oracles, replay, eval"));
  const Answer option = groundloop("list --colour");
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_THAT(option.err, AllOf(HasSubstr("--colour"), HasSubstr("See groundloop list --help")));
}

TEST_F(Eval, PrintsATable) {
  const Answer answer = groundloop("eval " + files());
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("pairs     40, aligned: se3"));
  EXPECT_THAT(answer.out, HasSubstr("APE                       0.010000"));
  EXPECT_THAT(answer.out, HasSubstr("trajectory.ate_rmse_m                 0.010000"));
  EXPECT_EQ(answer.err, "");
}

TEST_F(Eval, AnswersInJson) {
  const Answer answer = groundloop("eval --json --rpe-delta 2 --all-pairs " + files());
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  const json result = json::parse(answer.out);
  EXPECT_EQ(result.at("pairs"), 40);
  EXPECT_EQ(result.at("truth").at("format"), "tum");
  EXPECT_EQ(result.at("align").at("mode"), "se3");
  EXPECT_NEAR(result.at("ape").at("rmse"), 0.01, 1e-9);
  EXPECT_NEAR(result.at("ape").at("sse"), 0.004, 1e-9);
  EXPECT_EQ(result.at("rpe").at("n"), 38);
  EXPECT_NEAR(result.at("rpe").at("max"), 0, 1e-9);  // two steps on, the height is the same
  EXPECT_NEAR(result.at("metrics").at("trajectory.ate_rmse_m"), 0.01, 1e-9);
}

TEST_F(Eval, TakesEvosChoices) {
  const auto ape = [&](const std::string& options) {
    const Answer answer = groundloop("eval --json " + options + " " + files());
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    return json::parse(answer.out).at("ape").at("mean").get<double>();
  };
  EXPECT_NEAR(ape("--align se3 --relation angle_deg"), 0, 1e-6);
  EXPECT_NEAR(ape("--align none --relation angle_deg"), 30, 1e-6);
  EXPECT_GT(ape("--align none"), 3);
  EXPECT_NEAR(ape("--align origin"), 0.01, 1e-9);  // half of the poses are 2 cm off
}

TEST_F(Eval, OffsetAndLargestDifferencePairDifferently) {
  const auto pairs = [&](const std::string& options) {
    return json::parse(groundloop("eval --json " + options + " " + files()).out).at("pairs").get<int>();
  };
  EXPECT_EQ(pairs("--offset 10"), 30);
  EXPECT_EQ(pairs("--offset 0.5 --max-diff 0.6"), 40);
}

TEST_F(Eval, SaysWhatIsWrongWithTheFiles) {
  const Answer missing = groundloop("eval --truth absent.tum --estimate " + estimate_);
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_EQ(missing.err, "absent.tum: no such file: wanted a trajectory file\n");
  const Answer apart = groundloop("eval --offset 1000 " + files());
  EXPECT_EQ(apart.exit_code, 2);
  EXPECT_THAT(apart.err, HasSubstr("no stamp agrees with the truth's: wanted stamps within 0.01 s"));
}

TEST_F(Eval, DoesNotMixFilesWithAndWithoutStamps) {
  write_kitti(folder_ + "kitti.txt", circle(40, 3));
  write_kitti(folder_ + "short.txt", circle(39, 3));
  const Answer mixed = groundloop("eval --truth " + truth_ + " --estimate " + folder_ + "kitti.txt");
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.err, HasSubstr("kitti.txt: has no stamps: wanted the same as the truth"));
  const Answer unequal =
      groundloop("eval --truth " + folder_ + "kitti.txt --estimate " + folder_ + "short.txt");
  EXPECT_EQ(unequal.exit_code, 2);
  EXPECT_THAT(unequal.err, HasSubstr("short.txt: 39 poses: wanted 40 poses, as many as the truth has"));
}

TEST_F(Eval, SaysWhenNoSubTrajectoryIsThatLong) {
  const Answer answer = groundloop("eval --rpe-delta 500 --rpe-unit m " + files());
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err,
              HasSubstr("--rpe-delta: 500 m: wanted a length that some part of the trajectory has"));
}

TEST_F(Eval, WarnsWhenTheAlignmentIsOpen) {
  write_tum(truth_, straight(10, 1));
  write_tum(estimate_, straight(10, 1));
  const Answer answer = groundloop("eval " + files());
  EXPECT_EQ(answer.exit_code, 0);
  EXPECT_THAT(answer.err, HasSubstr("the positions lie on a line"));
}

TEST_F(Eval, RefusesBadChoices) {
  const Answer choice = groundloop("eval --align so3 " + files());
  EXPECT_EQ(choice.exit_code, 2);
  EXPECT_THAT(choice.err, HasSubstr("--align: so3 not in {none,se3,sim3,scale,origin}"));
  EXPECT_EQ(groundloop("eval --rpe-delta 0 " + files()).exit_code, 2);
  const Answer half = groundloop("eval --rpe-delta 0.5 " + files());
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_EQ(half.err, "--rpe-delta: 0.5: wanted at least 1 frame\n");
  const Answer required = groundloop("eval --truth " + truth_);
  EXPECT_EQ(required.exit_code, 2);
  EXPECT_THAT(required.err, HasSubstr("--estimate is required"));
}

TEST_F(Eval, FitsTheLeverArmOfAPointTruth) {
  const Answer answer = groundloop("eval --planar --json " + files());
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_LT(json::parse(answer.out).at("metrics").at("trajectory.planar_rmse_m").get<double>(), 1e-3);
}

TEST(Validate, AcceptsTheProjectsScenarios) {
  const Answer answer = groundloop("validate scenarios/*.yaml");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("scenarios/lab_p3dx.yaml: valid\n"));
  EXPECT_EQ(answer.err, "");
}

TEST(Validate, PrintsEveryProblemOfEveryFile) {
  const std::string folder = testing::TempDir() + "/groundloop_validate/";
  std::filesystem::create_directories(folder);
  const std::string file = folder + "bad.yaml";
  std::ofstream(file) << "format: 1\nname: bad\nwrold: x.xml\nplan: {speed_mps: fast}\n";
  const Answer answer = groundloop("validate scenarios/smoke.yaml " + file + " absent.yaml");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.out, HasSubstr("scenarios/smoke.yaml: valid\n"));
  EXPECT_THAT(answer.err,
              AllOf(HasSubstr(file + ":3: wrold: unknown key"), HasSubstr(file + ":4: plan.speed_mps: fast"),
                    HasSubstr("absent.yaml: no such file")));

  const Answer as_json = groundloop("validate --json " + file);
  EXPECT_EQ(as_json.exit_code, 2);
  const json result = json::parse(as_json.out);
  ASSERT_EQ(result.size(), 1u);
  EXPECT_EQ(result[0].at("valid"), false);
  EXPECT_GE(result[0].at("problems").size(), 3u);
  std::filesystem::remove_all(folder);
}

TEST(Validate, ChecksTheOptionsOfTheCoreAndTheModelsToo) {
  // Everything but two lines is the smoke scenario.
  const std::string folder = testing::TempDir() + "/groundloop_validate_core/";
  std::filesystem::create_directories(folder);
  std::string text = text_of("scenarios/smoke.yaml");
  const std::string root = std::filesystem::current_path().string();
  for (size_t at = text.find("../models"); at != std::string::npos; at = text.find("../models", at)) {
    text.replace(at, 2, root);
  }
  const size_t slam = text.find("\nslam:");
  if (slam != std::string::npos) text.erase(slam + 1, text.find('\n', slam + 1) - slam);
  const auto lines = std::count(text.begin(), text.end(), '\n');
  const std::string file = folder + "core.yaml";
  std::ofstream(file) << text << "slam: {preset: best, set: {tracking.max_featurs: 400}}\n";
  const Answer answer = groundloop("validate " + file);
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, AllOf(HasSubstr(file + ":" + std::to_string(lines + 1) + ": slam.preset: best"),
                                HasSubstr("max_featurs: unknown key")));
  std::filesystem::remove_all(folder);
}

TEST(List, ShowsNamesAndSummaries) {
  const Answer answer = groundloop("list");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, ContainsRegex("lab_p3dx +Pioneer 3-DX drives"));
  const json result = json::parse(groundloop("list scenarios --json").out);
  ASSERT_GE(result.size(), 2u);
  const auto lab = std::find_if(result.begin(), result.end(),
                                [](const json& entry) { return entry.at("name") == "lab_p3dx"; });
  ASSERT_NE(lab, result.end());
  EXPECT_EQ(lab->at("file"), "scenarios/lab_p3dx.yaml");
}

TEST(List, NeedsAFolder) {
  const Answer answer = groundloop("list no/such/folder");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_EQ(answer.err, "no/such/folder: No such file or directory: wanted a folder of scenario files\n");
}

TEST(Run, RefusesBadArgumentsBeforeAnythingRuns) {
  const Answer seeds = groundloop("run scenarios/smoke.yaml --seed 5..2");
  EXPECT_EQ(seeds.exit_code, 2);
  EXPECT_EQ(seeds.err, "--seed: 5..2: wanted a whole number, or A..B with A at most B\n");
  const Answer set = groundloop("run scenarios/smoke.yaml --set seed");
  EXPECT_EQ(set.exit_code, 2);
  EXPECT_EQ(set.err, "--set: seed: wanted key=value, such as slam.preset=paper\n");
  const Answer oracle = groundloop("run scenarios/smoke.yaml --oracle depth");
  EXPECT_EQ(oracle.exit_code, 2);
  EXPECT_EQ(oracle.err, "--oracle: depth: wanted one of: tracking, stereo, motion, loops\n");
  const Answer junit = groundloop("run scenarios/smoke.yaml --junit no/such/folder/a.xml");
  EXPECT_EQ(junit.exit_code, 2);
  EXPECT_EQ(junit.err, "--junit: no/such/folder/a.xml: wanted a file in a writable folder\n");
  EXPECT_EQ(groundloop("run scenarios/smoke.yaml --frames 0").exit_code, 2);
  EXPECT_EQ(groundloop("run scenarios/smoke.yaml --jobs 0").exit_code, 2);
  EXPECT_EQ(groundloop("run").exit_code, 2);
}

TEST(Run, TakesRepeatableOptionsManyTimesAndOneValueEach) {
  // Whatever was given last is what is wrong here: the ones before it, and the scenario after it, were taken.
  const Answer set = groundloop("run --set seed=2 --set plan.speed_mps=0.2 --set seed scenarios/smoke.yaml");
  EXPECT_EQ(set.err, "--set: seed: wanted key=value, such as slam.preset=paper\n");
  const Answer oracle = groundloop("run --oracle motion --oracle depth scenarios/smoke.yaml");
  EXPECT_EQ(oracle.err, "--oracle: depth: wanted one of: tracking, stereo, motion, loops\n");
  const Answer replay = groundloop("replay --set seed=2 --set seed no/such/sequence");
  EXPECT_EQ(replay.err, "--set: seed: wanted key=value, such as slam.preset=paper\n");
  const Answer preview = groundloop("preview --set seed=2 --set seed scenarios/smoke.yaml");
  EXPECT_EQ(preview.err, "--set: seed: wanted key=value, such as slam.preset=paper\n");
}

TEST(Run, NamesAMissingScenario) {
  const Answer answer = groundloop("run absent.yaml");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, StartsWith("absent.yaml: no such file"));
  EXPECT_THAT(answer.err, Not(HasSubstr("internal error")));
}

TEST(Oracles, NamesAMissingScenario) {
  const Answer answer = groundloop("oracles absent.yaml");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, StartsWith("absent.yaml: no such file"));
  EXPECT_EQ(groundloop("oracles").exit_code, 2);
}

TEST(Replay, NamesAMissingFolder) {
  const Answer answer = groundloop("replay no/such/sequence");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("no/such/sequence"));
  EXPECT_EQ(groundloop("replay . --format rosbag").exit_code, 2);
}

}  // namespace
}  // namespace groundloop::bench
