// Robots that differ from what they take themselves for, floors that are not smooth, casters that swing
// round, and the core's pose that makes up for it.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/robot/pose2.h"
#include "sim/simulation/simulation.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Scenario on_the_floor(const std::string& plan, const std::string& more = "") {
  return pioneer_in(write_world("realism", kFloor + more), plan);
}

std::vector<Exposure> driven(const Scenario& scenario, double rate_hz = 7.5) {
  const World world = World::load(scenario);
  HeadModel head = load_head(scenario.head.model);
  head.rate_hz = rate_hz;
  Simulation simulation(world, head, scenario);
  std::vector<Exposure> exposures;
  while (auto exposure = simulation.advance()) {
    exposure->state.reset();  // the world ends here
    exposure->state_right.reset();
    exposures.push_back(std::move(*exposure));
  }
  return exposures;
}

/// UMBmark in open loop: where a robot ends that believes it has driven a square.
Pose2 square_end(double side_m, int sign, const DriveErrors& errors) {
  Scenario scenario =
      on_the_floor("  speed_mps: 0.4\n  turn_rate_limit_degps: 45\n  segments: [{stop_s: 0}]\n");
  scenario.plan.segments.clear();
  for (int corner = 0; corner < 4; ++corner) {
    Segment side, turn;
    side.straight_m = side_m;
    turn.arc = ArcSegment{0, sign * 90.0};
    scenario.plan.segments.insert(scenario.plan.segments.end(), {side, turn});
  }
  scenario.robot.drive = errors;
  scenario.robot.odometry = {76600, 1, 1, 0};
  const auto exposures = driven(scenario, 1);
  EXPECT_LT(exposures.back().T_odom_body.translation().norm(), 0.01)
      << "the robot believes the square closed";
  return to_pose2(exposures.back().T_world_body);
}

TEST(DriveErrors, UmbmarkRecoversThem) {
  const DriveErrors errors{1.005, 0.98};
  const double L = 2, track_m = 0.33;
  const double x_ccw = square_end(L, 1, errors).x_m, x_cw = square_end(L, -1, errors).x_m;
  const double alpha_rad = (x_cw + x_ccw) / (-4 * L), beta_rad = (x_cw - x_ccw) / (-4 * L);
  const double R = (L / 2) / std::sin(beta_rad / 2);
  EXPECT_NEAR((R + track_m / 2) / (R - track_m / 2), errors.diameter_ratio, 0.0006) << "E_d";
  EXPECT_NEAR((std::numbers::pi / 2) / (std::numbers::pi / 2 - alpha_rad), errors.track_ratio, 0.003)
      << "E_b";
}

const std::string kRidge =
    "<geom name='duct' type='capsule' size='0.008' fromto='0.6 -2 -0.001 0.6 2 -0.001'/>";

double pitch_rad(const Exposure& exposure) { return -std::asin(exposure.T_world_body.linear()(2, 0)); }

TEST(Bumps, ACableDuctPitchesTheHead) {
  const std::string plan = "  speed_mps: 0.25\n  segments: [{straight_m: 1.2}, {stop_s: 0.3}]\n";
  double up_rad = 0, down_rad = 0, level_rad = 0;
  for (const Exposure& exposure : driven(on_the_floor(plan, kRidge), 50)) {
    up_rad = std::min(up_rad, pitch_rad(exposure));
    down_rad = std::max(down_rad, pitch_rad(exposure));
  }
  for (const Exposure& exposure : driven(on_the_floor(plan), 50)) {
    level_rad = std::max(level_rad, std::abs(pitch_rad(exposure)));
  }
  // 7 mm under the wheels, then under the caster, 0.21 m apart
  const double expected_rad = std::atan(0.007 / 0.211);
  EXPECT_NEAR(-up_rad, expected_rad, 0.6 * kDegree) << "wheels on the duct: the head looks up";
  EXPECT_NEAR(down_rad, expected_rad, 0.6 * kDegree) << "caster on the duct: it looks down";
  EXPECT_LT(level_rad, 0.1 * kDegree);
}

TEST(Bumps, TheRobotGetsOver) {
  const auto exposures =
      driven(on_the_floor("  speed_mps: 0.25\n  segments: [{straight_m: 1.2}, {stop_s: 0.3}]\n", kRidge));
  EXPECT_NEAR(exposures.back().T_world_body.translation().x(), 1.2, 0.03);
}

/// Farthest from the plan, aside, over a drive.
double strayed_m(const std::string& segments) {
  double most_m = 0;
  for (const Exposure& e : driven(on_the_floor("  speed_mps: 0.3\n  segments: " + segments + "\n"), 25)) {
    most_m = std::max(most_m, std::abs(to_pose2(e.T_plan_body.inverse() * e.T_world_body).y_m));
  }
  return most_m;
}

TEST(Caster, ItsSwingingRoundPushesTheRobotAside) {
  const double straight_m = strayed_m("[{straight_m: 0.5}, {straight_m: 0.5}]");
  const double reversed_m = strayed_m("[{arc: {radius_m: 0.5, angle_deg: 20}}, {straight_m: -0.5}]");
  EXPECT_LT(straight_m, 0.0005) << "a caster that trails already does nothing";
  EXPECT_GT(reversed_m, 2 * straight_m) << "one that must swing round kicks";
  EXPECT_LT(reversed_m, 0.02);
}

/// Drives with a core that always finds the true pose.
struct Steered {
  World world;
  HeadModel head;
  std::vector<Exposure> exposures;
  std::vector<int64_t> asked;

  explicit Steered(const Scenario& scenario)
      : world(World::load(scenario)), head(load_head(scenario.head.model)) {
    Simulation simulation(world, head, scenario, [this](int64_t exposure) -> std::optional<slam::Pose> {
      asked.push_back(exposure);
      const auto& first = exposures.front();
      return first.T_world_body.inverse() * exposures[static_cast<size_t>(exposure)].T_world_left;
    });
    while (auto exposure = simulation.advance()) exposures.push_back(std::move(*exposure));
  }
};

double end_deviation_m(const Exposure& end) {
  return (end.T_plan_body.inverse() * end.T_world_body).translation().head<2>().norm();
}

const std::string kBend =
    "  segments: [{straight_m: 1}, {arc: {radius_m: 0.8, angle_deg: 90}}, {straight_m: 1}]\n";

TEST(SteeredBySlam, TheCoresPoseMakesUpForAnUnequalDrive) {
  Scenario scenario = on_the_floor("  speed_mps: 0.3\n  feedback: slam\n" + kBend);
  scenario.robot.drive = {1.03, 1.03};
  const Steered steered(scenario);
  EXPECT_LT(end_deviation_m(steered.exposures.back()), 0.03);
  scenario.plan.feedback = Feedback::kPlan;
  EXPECT_GT(end_deviation_m(driven(scenario).back()), 0.3) << "open loop";
}

TEST(SteeredBySlam, APoseActsAFixedNumberOfPairsLater) {
  const Steered steered(
      on_the_floor("  speed_mps: 0.3\n  feedback: slam\n  segments: [{straight_m: 0.5}]\n"));
  ASSERT_EQ(steered.asked.size(), steered.exposures.size() - 2)
      << "before exposure 2 there is nothing to ask";
  for (size_t i = 0; i < steered.asked.size(); ++i) EXPECT_EQ(steered.asked[i], static_cast<int64_t>(i));
}

TEST(SteeredBySlam, WithoutAPoseItGoesOnByOdometry) {
  Scenario scenario = on_the_floor("  speed_mps: 0.3\n  feedback: slam\n" + kBend);
  scenario.robot.odometry = {76600, 1, 1, 0};
  const World world = World::load(scenario);
  Simulation simulation(world, load_head(scenario.head.model), scenario,
                        [](int64_t) -> std::optional<slam::Pose> { return std::nullopt; });
  std::optional<Exposure> last;
  while (auto exposure = simulation.advance()) last = std::move(exposure);
  EXPECT_LT(end_deviation_m(*last), 0.01) << "exact odometry is as good as the truth here";
}

}  // namespace
}  // namespace groundloop::sim
