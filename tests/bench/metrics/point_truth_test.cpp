#include "bench/metrics/point_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/metrics/poses.h"
#include "tests/bench/metrics/test_folder.h"

namespace groundloop::bench {
namespace {

const Eigen::Vector3d kLever(0.05, 0.1, -0.25);

/// A rover on a figure of eight: camera poses in the world, z forward, y down, tilted down by 15 degrees.
slam::Trajectory camera_path(int poses) {
  Eigen::Matrix3d R_body_left;
  R_body_left << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  slam::Trajectory path;
  for (int i = 0; i < poses; ++i) {
    const double phase = 2 * std::numbers::pi * i / poses;
    const double yaw_rad = std::atan2(2 * std::cos(2 * phase), 2 * std::cos(phase));
    slam::Pose T = moved(2 * std::sin(phase), std::sin(2 * phase), 0.3);
    T.linear() = (turned(yaw_rad / kRadPerDeg, Eigen::Vector3d::UnitZ()).linear() * R_body_left) *
                 turned(-15, Eigen::Vector3d::UnitX()).linear();
    path.push_back(at(i, T));
  }
  return path;
}

/// Where the tracked point is, at the stamps of the camera.
PointTruth seen_point(const slam::Trajectory& T_world_left) {
  PointTruth truth;
  for (const auto& pose : T_world_left) truth.push_back({pose.stamp_ns, (pose.T * kLever).head<2>()});
  return truth;
}

slam::Trajectory in_map(const slam::Trajectory& T_world_left) {
  slam::Trajectory estimate = T_world_left;
  for (auto& pose : estimate) pose.T = moved(4, -2, 1) * turned(110, {0.2, 1, 0.4}) * pose.T;
  return estimate;
}

TEST(PlanarFit, OfAPerfectEstimateFindsTheLeverArm) {
  const auto path = camera_path(60);
  const auto fit = fit_planar(seen_point(path), in_map(path));
  ASSERT_TRUE(fit);
  // The weight that keeps the lever arm short pulls by micrometres.
  EXPECT_LT(fit->rmse_m, 1e-4);
  // Up and down the lever arm is open on a plane: compare along the horizontal.
  const Eigen::Vector3d off_world = path[0].T.linear() * (fit->p_left_point - kLever);
  EXPECT_LT(off_world.head<2>().norm(), 1e-3);
}

TEST(PlanarFit, MeasuresTheErrorThatWasPutIn) {
  // The truth jumps by 2 cm to the left and right of the path in turns: no rigid motion can follow that.
  const auto path = camera_path(60);
  PointTruth truth = seen_point(path);
  for (size_t i = 0; i < truth.size(); ++i) truth[i].p_world.y() += i % 2 == 0 ? 0.02 : -0.02;
  const auto fit = fit_planar(truth, in_map(path));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rmse_m, 0.02, 2e-4);
  EXPECT_NEAR(fit->max_m, 0.02, 1e-3);
}

TEST(PlanarFit, DoesNotFollowAFewBadTruthPoints) {
  const auto path = camera_path(60);
  PointTruth truth = seen_point(path);
  truth[20].p_world.x() += 1;
  const auto fit = fit_planar(truth, in_map(path));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->max_m, 1, 0.01);
  EXPECT_NEAR(fit->rmse_m, 1 / std::sqrt(60.0), 2e-3);
}

TEST(PlanarFit, DoesNotUndoAScaleError) {
  const auto path = camera_path(60);
  slam::Trajectory shrunk = in_map(path);
  for (auto& pose : shrunk) pose.T.translation() *= 0.9;
  EXPECT_GT(fit_planar(seen_point(path), shrunk)->rmse_m, 0.1);
}

TEST(PlanarFit, InterpolatesTheTruth) {
  const auto path = camera_path(240);
  slam::Trajectory shifted =
      in_map(path);  // a quarter of a step late, and the first and last beyond the truth
  for (auto& pose : shifted) pose.stamp_ns += 250'000'000;
  const auto shifted_fit = fit_planar(seen_point(path), shifted);
  // a step is at most 4 / 240 * pi m = 52 mm long
  EXPECT_LT(shifted_fit->rmse_m, 0.25 * 0.053);
  PointTruth between = seen_point(path);
  for (auto& point : between) point.stamp_ns += 250'000'000;
  EXPECT_LT(fit_planar(between, shifted)->rmse_m, 1e-4);
}

TEST(PlanarFit, NeedsThreePosesAndATruth) {
  const auto path = camera_path(2);
  EXPECT_FALSE(fit_planar(seen_point(path), path));
  EXPECT_FALSE(fit_planar({}, camera_path(20)));
}

// A sample with the answer of scipy.optimize.least_squares (soft_l1, f_scale 0.05) on the same cost,
// tolerances 1e-15.
TEST(PlanarFit, AgreesWithScipy) {
  const auto path = camera_path(40);
  PointTruth truth = seen_point(path);
  for (size_t i = 0; i < truth.size(); ++i) {
    const auto phase = static_cast<double>(i);
    truth[i].p_world += 0.03 * Eigen::Vector2d(std::sin(1.7 * phase), std::cos(2.9 * phase));
    if (i % 13 == 5) truth[i].p_world.x() += 0.2;
  }
  const auto fit = fit_planar(truth, path);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rmse_m, 0.0631593799, 1e-7);
  EXPECT_NEAR(fit->max_m, 0.2190643772, 1e-6);
}

TEST(PointTruth, ReadsSecondsAndPlace) {
  const TestFolder folder;
  const PointTruth truth = read_point_truth(folder.write("p.tum", "2.5 3 4 0 0 0 0 1\n3.5 5 6 0 0 0 0 1\n"));
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_EQ(truth[1].stamp_ns, 3'500'000'000);
  EXPECT_EQ(truth[1].p_world, Eigen::Vector2d(5, 6));
}

TEST(PlanarMetrics, HaveTheirNames) {
  PlanarFit fit;
  fit.rmse_m = 0.01;
  fit.max_m = 0.02;
  EXPECT_EQ(planar_metrics(fit),
            (Metrics{{"trajectory.planar_rmse_m", 0.01}, {"trajectory.planar_max_m", 0.02}}));
}

}  // namespace
}  // namespace groundloop::bench
