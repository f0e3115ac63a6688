#include "sim/scenario/scenario.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace groundloop::sim {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A folder with the three model files that a scenario names.
class ScenarioFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("groundloop_scenario_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "models");
    for (const char* name : {"room.xml", "robot.xml", "head.yaml"})
      std::ofstream(folder_ / "models" / name) << "\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& text, const std::string& name = "test.yaml") const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// Messages of a file that must be refused, with the folder left out.
  std::vector<std::string> messages(const std::string& text,
                                    const std::vector<Override>& overrides = {}) const {
    const std::string file = write(text);
    try {
      load_scenario(file, overrides);
    } catch (const InputError& e) {
      std::vector<std::string> lines;
      for (Problem problem : e.problems()) {
        problem.file = fs::path(problem.file).filename().string();
        lines.push_back(problem.text());
      }
      return lines;
    }
    return {};
  }

  fs::path folder_;
};

const std::string kHead = R"(format: 1
name: test
world: models/room.xml
robot: {model: models/robot.xml, start: {x_m: 1.5, yaw_deg: 90}}
head: {model: models/head.yaml}
)";
const std::string kGood = kHead + R"(plan:
  speed_mps: 0.2
  segments:
    - {straight_m: 2}
    - {arc: {radius_m: 1, angle_deg: -90}}
    - {stop_s: 1.5}
slam:
  preset: paper
  set:
    tracking.max_features: 300
    tracking.window: 15
expect:
  outcome: tracked
  trajectory.ate_rmse_m: {max: 0.02}
  map.with_true_poses.f1: {min: 0.9, max: 1}
seed: 7
)";

TEST_F(ScenarioFiles, ReadsEveryPart) {
  const Scenario s = load_scenario(write(kGood));
  EXPECT_EQ(s.name, "test");
  EXPECT_EQ(s.seed, 7U);
  EXPECT_EQ(s.robot.start.x_m, 1.5);
  EXPECT_EQ(s.robot.start.yaw_deg, 90);
  EXPECT_EQ(s.robot.odometry.diameter_ratio, 1.002) << "a default";
  EXPECT_EQ(s.plan.feedback, Feedback::kPlan);
  ASSERT_EQ(s.plan.segments.size(), 3U);
  EXPECT_EQ(s.plan.segments[0].straight_m, 2);
  EXPECT_EQ(s.plan.segments[1].arc->angle_deg, -90);
  EXPECT_EQ(s.plan.segments[2].stop_s, 1.5);
  EXPECT_EQ(s.slam.preset, "paper");
  EXPECT_EQ(s.slam.set.at("tracking.max_features"), "300");
  EXPECT_EQ(s.expect.outcome, "tracked");
  EXPECT_EQ(s.expect.metrics.size(), 2U);
  EXPECT_EQ(s.expect.metrics.at("trajectory.ate_rmse_m").max, 0.02);
  EXPECT_FALSE(s.expect.metrics.at("trajectory.ate_rmse_m").min.has_value());
}

TEST_F(ScenarioFiles, PathsAreAbsoluteAndRelativeToTheFile) {
  const Scenario s = load_scenario(write(kGood));
  EXPECT_EQ(s.world.file, (folder_ / "models" / "room.xml").string());
  EXPECT_EQ(s.robot.model, (folder_ / "models" / "robot.xml").string());
  EXPECT_EQ(s.head.model, (folder_ / "models" / "head.yaml").string());
}

TEST_F(ScenarioFiles, RemembersLinesForLaterMessages) {
  const Scenario s = load_scenario(write(kGood));
  EXPECT_EQ(s.robot.start.line, 4);
  EXPECT_EQ(s.plan.segments[0].line, 9);
  EXPECT_EQ(s.plan.segments[2].line, 11);
  EXPECT_EQ(s.slam.preset_line, 13);
  EXPECT_EQ(s.slam.set_lines.at("tracking.window"), 16);
}

TEST_F(ScenarioFiles, WrittenScenarioLoadsAgainAsTheSame) {
  const Scenario s = load_scenario(write(kGood), {{"plan.feedback", "odometry"}, {"robot.start.y_m", "0.1"}});
  const std::string text = to_yaml(s);
  const Scenario again = load_scenario(write(text, "resolved.yaml"));
  EXPECT_EQ(to_yaml(again), text);
  EXPECT_EQ(again.plan.feedback, Feedback::kOdometry);
  EXPECT_EQ(again.robot.start.y_m, 0.1) << "to the last bit";
  EXPECT_EQ(again.world.file, s.world.file);
  EXPECT_EQ(again.slam.set, s.slam.set);
  EXPECT_EQ(again.expect.metrics.at("map.with_true_poses.f1").min, 0.9);
}

TEST_F(ScenarioFiles, EveryProblemIsReportedAtOnce) {
  const auto lines = messages(R"(format: 2
name: a/b
world: models/rome.xml
robot: {model: models/robot.xml, strat: {x_m: 1}}
head: {model: models/head.yaml}
plan:
  speed_mps: fast
  feedback: gps
  segments:
    - {straight_m: 2, stop_s: 1}
    - {arc: {radius_m: -1}}
seed: -3
)");
  EXPECT_THAT(
      lines,
      ElementsAre(
          "test.yaml:1: format: 2: wanted 1, the only format this version reads",
          "test.yaml:2: name: a/b: wanted letters, digits, dots, dashes and underscores: it names the run "
          "folder",
          "test.yaml:3: world: models/rome.xml: wanted an MJCF file that exists (looked for " +
              (folder_ / "models" / "rome.xml").string() + ")",
          "test.yaml:4: robot.strat: unknown key: wanted one of: arm, drive, model, odometry, start (did you "
          "mean start?)",
          "test.yaml:7: plan.speed_mps: fast: wanted a number from 0.01 to 1.2",
          "test.yaml:8: plan.feedback: gps: wanted one of: plan, odometry, slam, truth",
          "test.yaml:10: plan.segments[0]: {straight_m: 2, stop_s: 1}: wanted exactly one of: straight_m, "
          "arc, "
          "stop_s, look",
          "test.yaml:11: plan.segments[1].arc.radius_m: -1: wanted a number from 0 to 1000",
          "test.yaml:11: plan.segments[1].arc.angle_deg: missing: wanted a number from -36000 to 36000",
          "test.yaml:12: seed: -3: wanted a whole number"));
}

TEST_F(ScenarioFiles, LooksHaveAPanAndATilt) {
  const Scenario s = load_scenario(write(kHead + R"(plan:
  speed_mps: 0.2
  segments: [{look: {pan_deg: 30}}, {look: {pan_deg: -60, tilt_deg: 10}}]
)"));
  EXPECT_EQ(s.plan.look_speed_degps, 20);
  ASSERT_EQ(s.plan.segments.size(), 2u);
  EXPECT_EQ(s.plan.segments[0].look->pan_deg, 30);
  EXPECT_EQ(s.plan.segments[0].look->tilt_deg, 0);
  EXPECT_EQ(s.plan.segments[1].look->tilt_deg, 10);
  EXPECT_THAT(
      messages(kHead + R"(plan:
  speed_mps: 0.2
  look_speed_degps: 0
  segments: [{look: {tilt_deg: 100}}]
)"),
      ElementsAre("test.yaml:8: plan.look_speed_degps: 0: wanted a number from 0.1 to 300",
                  "test.yaml:9: plan.segments[0].look.pan_deg: missing: wanted a number from -180 to "
                  "180",
                  "test.yaml:9: plan.segments[0].look.tilt_deg: 100: wanted a number from -90 to 90"));
}

TEST_F(ScenarioFiles, FaultsAreATimeline) {
  const Scenario s = load_scenario(write(kGood + R"(faults:
  - {at_s: 12, for_s: 3, wheel_slip: {left: 0.3}}
  - {at_s: 1, kidnap: {x_m: 1, y_m: 2, yaw_deg: 30}}
  - {at_s: 2.5, blur: {sigma_px: 2, camera: right}}
)"));
  ASSERT_EQ(s.faults.size(), 3U);
  EXPECT_EQ(s.faults[0].kind(), "wheel_slip");
  EXPECT_EQ(s.faults[0].wheel_slip->left, 0.3);
  EXPECT_EQ(s.faults[0].wheel_slip->right, 0);
  EXPECT_EQ(s.faults[0].line, 23);
  EXPECT_TRUE(s.faults[0].active(12));
  EXPECT_TRUE(s.faults[0].active(14.999));
  EXPECT_FALSE(s.faults[0].active(15)) << "over at its end";
  EXPECT_EQ(s.faults[1].kind(), "kidnap");
  EXPECT_EQ(s.faults[1].end_s(), 1) << "over at once";
  EXPECT_EQ(s.faults[2].blur->camera, FaultCamera::kRight);
  EXPECT_TRUE(s.faults[2].active(1e6)) << "without for_s until the end";
  EXPECT_EQ(s.faults[2].line, 25);

  const std::string text = to_yaml(s);
  EXPECT_EQ(to_yaml(load_scenario(write(text, "resolved.yaml"))), text);
  const Scenario replaced = load_scenario(write(kGood), {{"faults", "[{at_s: 1, drop: {}}]"}});
  ASSERT_EQ(replaced.faults.size(), 1U);
  EXPECT_EQ(replaced.faults[0].drop->probability, 1);
}

TEST_F(ScenarioFiles, WhoSteersBySlamIsNotKidnapped) {
  EXPECT_THAT(
      messages(kHead + R"(plan:
  speed_mps: 0.2
  feedback: slam
  segments: [{straight_m: 1}]
faults: [{at_s: 1, kidnap: {x_m: 1, y_m: 2, yaw_deg: 30}}]
)"),
      ElementsAre("test.yaml:10: faults: kidnap with feedback: slam: wanted no kidnapping while SLAM steers: "
                  "once it knows the place, it would drive straight back to its path"));
}

TEST_F(ScenarioFiles, PeopleMovesAndLightsAreRead) {
  const Scenario s = load_scenario(write(kGood + R"(people:
  - {name: anna, model: models/robot.xml, at_s: 3, way: [{x_m: 1, y_m: 2}, {x_m: 3, y_m: 4}]}
moves:
  - {at_s: 5, body: chair, x_m: 1, y_m: 2, yaw_deg: 90}
lights:
  - {at_s: 1, light: lamp, factor: 0}
  - {at_s: 2, for_s: 1, flicker: {rate_hz: 5, depth: 0.5}}
)"));
  ASSERT_EQ(s.people.size(), 1U);
  EXPECT_EQ(s.people[0].model, (folder_ / "models" / "robot.xml").string());
  EXPECT_EQ(s.people[0].way[1].y_m, 4);
  EXPECT_EQ(s.people[0].line, 23);
  EXPECT_EQ(s.moves.at(0).body, "chair");
  EXPECT_EQ(s.moves[0].line, 25);
  EXPECT_EQ(s.lights.at(1).flicker->rate_hz, 5);
  EXPECT_EQ(s.lights[1].line, 28);
  const std::string text = to_yaml(s);
  EXPECT_EQ(to_yaml(load_scenario(write(text, "resolved.yaml"))), text);
  EXPECT_THAT(messages(kGood + "people: [{name: a b, model: nobody.xml, way: []}]\n"),
              ElementsAre(HasSubstr("people[0].name: a b: wanted letters, digits, dashes and underscores"),
                          HasSubstr("people[0].way: []: wanted at least one point"),
                          HasSubstr("people[0].model: nobody.xml: wanted an MJCF file that exists")));
}

TEST_F(ScenarioFiles, WrongFaultsNameLineKeyAndWhatIsWanted) {
  EXPECT_THAT(
      messages(kGood + R"(faults:
  - {at_s: 12, for_s: 3}
  - {at_s: 1, for_s: 3, kidnap: {x_m: 1, y_m: 2, yaw_deg: 30}}
  - {for_s: 0, drop: {}}
  - {at_s: 1, swap: {}, late: {pairs: 0}}
  - {at_s: 1, bluur: {sigma_px: 1}, blur: {sigma_px: 1, camera: middle}}
)"),
      ElementsAre(
          "test.yaml:23: faults[0]: {at_s: 12, for_s: 3}: wanted at_s, for_s and exactly one of: drop, "
          "duplicate, late, swap, trigger_offset, exposure, flash, blackout, dirt, blur, knock, "
          "wheel_slip, kidnap, encoder",
          "test.yaml:24: faults[1].for_s: 3: wanted no for_s: a kidnapping is over at once",
          "test.yaml:25: faults[2].at_s: missing: wanted a number from 0 to 100000",
          "test.yaml:25: faults[2].for_s: 0: wanted a number from 0.001 to 100000",
          HasSubstr("test.yaml:26: faults[3].late.pairs: 0: wanted a whole number from 1 to 100"),
          HasSubstr("test.yaml:26: faults[3]: {at_s: 1, swap: {}, late: {pairs: 0}}: wanted at_s, for_s "
                    "and exactly one of: drop,"),
          "test.yaml:27: faults[4].blur.camera: middle: wanted one of: both, left, right",
          HasSubstr("test.yaml:27: faults[4].bluur: unknown key: wanted")));
}

TEST_F(ScenarioFiles, ExpectationsAreChecked) {
  const std::string plan = "plan: {speed_mps: 0.2, segments: [{straight_m: 1}]}\n";
  EXPECT_THAT(
      messages(kHead + plan + R"(expect:
  outcome: won
  trajectory.ate_rms_m: {max: 1}
  map.f1: {min: 0.9, max: 0.5}
  map.iou: {}
)"),
      ElementsAre("test.yaml:8: expect.outcome: won: wanted one of: tracked, lost",
                  AllOf(HasSubstr("test.yaml:9: expect.trajectory.ate_rms_m: unknown key: wanted one of: "),
                        EndsWith("(did you mean trajectory.ate_rmse_m?)")),
                  "test.yaml:10: expect.map.f1: {min: 0.9, max: 0.5}: wanted min (0.9) not above max (0.5)",
                  "test.yaml:11: expect.map.iou: {}: wanted bounds: min and/or max"));
}

TEST_F(ScenarioFiles, AnEmptyPlanAndAMissingOne) {
  EXPECT_THAT(messages(kHead), ElementsAre("test.yaml:1: plan: missing: wanted a map of keys and values"));
  EXPECT_THAT(messages(kHead + "plan: {speed_mps: 0.2, segments: []}\n"),
              ElementsAre("test.yaml:6: plan.segments: []: wanted at least one segment"));
}

TEST_F(ScenarioFiles, AKeyGivenTwiceIsNotGuessedAt) {
  EXPECT_THAT(
      messages(kHead +
               "plan:\n  speed_mps: 0.2\n  segments: [{straight_m: 1, straight_m: 2}]\n  speed_mps: 0.3\n"),
      ElementsAre("test.yaml:8: plan.segments[0].straight_m: key given twice: wanted every key once",
                  "test.yaml:9: plan.speed_mps: key given twice: wanted every key once"));
}

TEST_F(ScenarioFiles, NotYamlNotThereNotAMap) {
  EXPECT_THAT(messages("plan: {speed_mps: 0.2\n"), ElementsAre(HasSubstr("wanted valid YAML")));
  EXPECT_THAT(messages("just words\n"),
              ElementsAre("test.yaml:1: just words: wanted a map of keys and values"));
  try {
    load_scenario((folder_ / "nowhere.yaml").string());
    FAIL() << "a missing file was accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), EndsWith("nowhere.yaml: no such file: wanted a YAML file that can be read"));
  }
}

TEST_F(ScenarioFiles, OverridesReplaceValues) {
  const Scenario s = load_scenario(write(kGood), {{"plan.speed_mps", "0.3"},
                                                  {"seed", "3"},
                                                  {"slam.preset", "default"},
                                                  {"slam.tracking.max_features", "400"},
                                                  {"slam.set.map.cell_m", "0.1"},
                                                  {"expect.trajectory.ate_rmse_m.max", "0.5"},
                                                  {"expect.map.f1", "{min: 0.4}"},
                                                  {"expect.outcome", "lost"},
                                                  {"plan.segments", "[{straight_m: 1}]"}});
  EXPECT_EQ(s.plan.speed_mps, 0.3);
  EXPECT_EQ(s.seed, 3U);
  EXPECT_EQ(s.slam.preset, "default");
  EXPECT_EQ(s.slam.preset_line, 0) << "not from the file any more";
  EXPECT_EQ(s.slam.set.at("tracking.max_features"), "400");
  EXPECT_EQ(s.slam.set_lines.at("tracking.max_features"), 0);
  EXPECT_EQ(s.slam.set.at("tracking.window"), "15") << "others stay";
  EXPECT_EQ(s.slam.set.at("map.cell_m"), "0.1");
  EXPECT_EQ(s.expect.metrics.at("trajectory.ate_rmse_m").max, 0.5);
  EXPECT_EQ(s.expect.metrics.at("map.f1").min, 0.4);
  EXPECT_EQ(s.expect.outcome, "lost");
  EXPECT_EQ(s.plan.segments.size(), 1U);
}

TEST_F(ScenarioFiles, ABadOverrideIsNamedAsOne) {
  EXPECT_THAT(
      messages(kGood, {{"plan.speed_mps", "fast"},
                       {"plan.sped_mps", "1"},
                       {"world", "nowhere.xml"},
                       {"expect.map.f2.min", "1"},
                       {"plan.segments", "[{straight_m: }"}}),
      ElementsAre("--set: plan.speed_mps: fast: wanted a number from 0.01 to 1.2",
                  "--set: plan.sped_mps: unknown key: wanted one of: feedback, generate, "
                  "look_speed_degps, path, poses, segments, speed_mps, turn_rate_limit_degps (did you mean speed_mps?)",
                  AllOf(HasSubstr("--set: expect.map.f2: unknown key"), EndsWith("(did you mean map.f1?)")),
                  HasSubstr("--set: plan.segments: [{straight_m: }: wanted valid YAML"),
                  HasSubstr("--set: world: nowhere.xml: wanted an MJCF file that exists")));
}

}  // namespace
}  // namespace groundloop::sim
