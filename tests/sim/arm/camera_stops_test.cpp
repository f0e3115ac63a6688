#include "sim/arm/camera_stops.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/arm/test_arm.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
constexpr int64_t kPeriod_ns = 2'000'000'000;

std::vector<CameraStop> stops_of(const std::string& plan) {
  return camera_stops(arm_among("stops", "", plan), kPeriod_ns);
}

double yaw_deg(const CameraStop& stop) {
  const Eigen::Vector3d look = stop.T_world_left.linear().col(2);
  return std::atan2(look.y(), look.x()) / kDegree;
}

TEST(CameraStops, ACameraLooksAlongYawAndTiltWithALevelRow) {
  const slam::Pose T = level_look({1, 2, 3}, 30 * kDegree, 20 * kDegree);
  EXPECT_LT((T.translation() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-15);
  const double level = std::cos(20 * kDegree);
  const Eigen::Vector3d look(level * std::cos(30 * kDegree), level * std::sin(30 * kDegree),
                             std::sin(20 * kDegree));
  EXPECT_LT((T.linear().col(2) - look).norm(), 1e-12);
  EXPECT_LT((T.linear().col(0) - Eigen::Vector3d(std::sin(30 * kDegree), -std::cos(30 * kDegree), 0)).norm(),
            1e-12);
  EXPECT_LT(T.linear()(2, 1), 0);  // y points down
  EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
}

TEST(CameraStops, PosesTakeTheirTimesOrTheNextPair) {
  const auto stops = stops_of(
      "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2}, {x_m: 0.4, y_m: 0, z_m: 0.2, yaw_deg: 40, "
      "at_s: 8}, "
      "{x_m: 0.5, y_m: 0, z_m: 0.2}]}");
  ASSERT_EQ(stops.size(), 3U);
  EXPECT_EQ(stops[0].first_pair, 0);
  EXPECT_EQ(stops[1].first_pair, 4);
  EXPECT_EQ(stops[2].first_pair, 5);
  EXPECT_NEAR(yaw_deg(stops[1]), 40, 1e-9);
  EXPECT_EQ(stops[1].key, "plan.poses[1]");
  EXPECT_GT(stops[1].line, 0);
}

TEST(CameraStops, TimesMustRiseByWholePairs) {
  const auto problems = problems_of([] {
    stops_of(
        "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0, z_m: 0.2, at_s: 2}, {x_m: 0.4, y_m: 0, z_m: 0.2, at_s: "
        "5}, "
        "{x_m: 0.4, y_m: 0, z_m: 0.2, at_s: 6}]}");
  });
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_THAT(problems[0].text(), HasSubstr("plan.poses[0].at_s: 2: wanted 0 for the first pose"));
  EXPECT_THAT(
      problems[1].text(),
      HasSubstr("plan.poses[1].at_s: 5: wanted a multiple of 2 s, the time between pairs, of at least 4"));
  EXPECT_THAT(
      problems[2].text(),
      HasSubstr("plan.poses[2].at_s: 6: wanted a multiple of 2 s, the time between pairs, of at least 8"));
}

TEST(CameraStops, ADriveIsCutEvenlyWithinEachPiece) {
  const auto stops = stops_of(
      "{speed_mps: 0.1, path: {z_m: 0.2, tilt_deg: 10, step_m: 0.03, step_deg: 90, drive: {x_m: 0.1, y_m: "
      "0.2, yaw_deg: "
      "90, pieces: [{straight_m: 0.1}, {sideways_m: 0.05}, {arc: {radius_m: 0.1, angle_deg: -90}}]}}}");
  // 0.1 m in 4 steps, 0.05 m in 2, a quarter circle of 0.157 m in 6
  ASSERT_EQ(stops.size(), 13U);
  EXPECT_LT((stops[4].T_world_left.translation() - Eigen::Vector3d(0.1, 0.3, 0.2)).norm(), 1e-12);
  EXPECT_LT((stops[6].T_world_left.translation() - Eigen::Vector3d(0.05, 0.3, 0.2)).norm(), 1e-12);
  EXPECT_LT((stops[12].T_world_left.translation() - Eigen::Vector3d(0.15, 0.4, 0.2)).norm(), 1e-12);
  EXPECT_NEAR(yaw_deg(stops[12]), 0, 1e-9);
  for (size_t i = 1; i < stops.size(); ++i) {
    EXPECT_LE((stops[i].T_world_left.translation() - stops[i - 1].T_world_left.translation()).norm(), 0.03);
    EXPECT_EQ(stops[i].first_pair, static_cast<int64_t>(i));
    EXPECT_NEAR(std::asin(stops[i].T_world_left.linear()(2, 2)) / kDegree, 10, 1e-9);
  }
}

TEST(CameraStops, AnArcIsCutByItsAngleWhenThatIsFiner) {
  const auto stops = stops_of(
      "{speed_mps: 0.1, path: {z_m: 0.2, step_m: 1, step_deg: 5, drive: {x_m: 0.4, y_m: 0, look_deg: -90, "
      "pieces: [{arc: "
      "{radius_m: 0, angle_deg: 45}}]}}}");
  ASSERT_EQ(stops.size(), 10U);
  EXPECT_NEAR(yaw_deg(stops[0]), -90, 1e-9);
  EXPECT_NEAR(yaw_deg(stops[9]), -45, 1e-9);
  EXPECT_LT((stops[9].T_world_left.translation() - stops[0].T_world_left.translation()).norm(), 1e-12);
}

TEST(CameraStops, ARasterGoesToAndFro) {
  const auto stops = stops_of(
      "{speed_mps: 0.1, path: {z_m: 0.2, step_m: 0.1, raster: {x_m: 0.3, y_m: 0, yaw_deg: 0, width_m: 0.2, "
      "depth_m: 0.2, "
      "rows: 3}}}");
  std::vector<std::pair<double, double>> places;
  for (const CameraStop& stop : stops) {
    places.emplace_back(std::round(1e6 * stop.T_world_left.translation().x()) / 1e6,
                        std::round(1e6 * stop.T_world_left.translation().y()) / 1e6);
  }
  const std::vector<std::pair<double, double>> expected = {{0.3, 0.1},  {0.3, 0}, {0.3, -0.1},
                                                           {0.4, -0.1}, {0.4, 0}, {0.4, 0.1},
                                                           {0.5, 0.1},  {0.5, 0}, {0.5, -0.1}};
  EXPECT_EQ(places, expected);
}

TEST(CameraStops, TheScaleIsOnPlacesAlone) {
  Scenario scenario =
      arm_among("scaled", "", "{speed_mps: 0.1, poses: [{x_m: 0.4, y_m: 0.1, z_m: 0.2, yaw_deg: 30}]}");
  scenario.scale = 4.4;
  const auto stops = camera_stops(scenario, kPeriod_ns);
  EXPECT_LT((stops[0].T_world_left.translation() - 4.4 * Eigen::Vector3d(0.4, 0.1, 0.2)).norm(), 1e-12);
  EXPECT_NEAR(yaw_deg(stops[0]), 30, 1e-9);
}

}  // namespace
}  // namespace groundloop::sim
