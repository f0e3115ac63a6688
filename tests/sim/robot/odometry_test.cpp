#include "sim/robot/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kPi = std::numbers::pi;
const DriveLimits kDrive{
    .wheel_radius_m = 0.0975, .track_m = 0.33, .wheel_speed_radps = 12, .wheel_acceleration_radps2 = 3};
constexpr OdometryModel kExact{
    .counts_per_rev = 100'000'000, .diameter_ratio = 1, .track_ratio = 1, .noise_m_per_sqrt_m = 0};

/// A perfect robot on the floor whose encoders feed an odometry.
class Rolling {
 public:
  explicit Rolling(const OdometryModel& model, uint64_t seed = 1) : odometry(model, kDrive, seed, 0, 0) {}

  void drive(double length_m, double turn_rad, int updates) {
    for (int i = 0; i < updates; ++i) {
      left_rad_ += (length_m - turn_rad * kDrive.track_m / 2) / kDrive.wheel_radius_m / updates;
      right_rad_ += (length_m + turn_rad * kDrive.track_m / 2) / kDrive.wheel_radius_m / updates;
      odometry.update(left_rad_, right_rad_);
      T_world_body = driven(T_world_body, length_m / updates, turn_rad / updates);
    }
  }
  Odometry odometry;
  Pose2 T_world_body;

 private:
  double left_rad_ = 0, right_rad_ = 0;
};

TEST(Odometry, WithoutErrorsItIsTheTruth) {
  Rolling robot(kExact);
  robot.drive(2, 0, 10);
  robot.drive(1.5 * kPi / 2, kPi / 2, 1);  // one update over a whole arc: the integration is exact
  robot.drive(0, -kPi, 7);
  robot.drive(-1, 0, 3);
  EXPECT_NEAR(robot.odometry.T_odom_body().x_m, robot.T_world_body.x_m, 1e-6);
  EXPECT_NEAR(robot.odometry.T_odom_body().y_m, robot.T_world_body.y_m, 1e-6);
  EXPECT_NEAR(robot.odometry.T_odom_body().yaw_rad, -kPi / 2, 1e-6);
}

TEST(Odometry, ReadsWholeCounts) {
  OdometryModel coarse = kExact;
  coarse.counts_per_rev = 100;
  Odometry odometry(coarse, kDrive, 1, 0, 0);
  const double count_rad = 2 * kPi / 100;
  odometry.update(0.9 * count_rad, 0.9 * count_rad);
  EXPECT_EQ(odometry.T_odom_body().x_m, 0);
  odometry.update(1.1 * count_rad, 1.1 * count_rad);
  EXPECT_NEAR(odometry.T_odom_body().x_m, count_rad * 0.0975, 1e-12);
  odometry.update(0.9 * count_rad, 0.9 * count_rad);
  EXPECT_NEAR(odometry.T_odom_body().x_m, 0, 1e-12) << "no drift from rocking on one count";
}

/// Drives a square of side L as the odometry sees it, and says where the robot truly ends (UMBmark).
Eigen::Vector2d umbmark_end_m(const OdometryModel& model, double side_m, int sign) {
  // The odometry believes f(true motion), linear in the two wheels: inverted, so that it sees the square.
  const double e = model.diameter_ratio;
  const double left_gain = 2 / (e + 1), right_gain = 2 * e / (e + 1);  // true way per believed way
  const double believed_track_m = kDrive.track_m / model.track_ratio;
  Rolling robot(model);
  const auto drive_believed = [&](double length_m, double turn_rad) {
    const double left_m = left_gain * (length_m - turn_rad * believed_track_m / 2);
    const double right_m = right_gain * (length_m + turn_rad * believed_track_m / 2);
    robot.drive((left_m + right_m) / 2, (right_m - left_m) / kDrive.track_m, 500);
  };
  for (int corner = 0; corner < 4; ++corner) {
    drive_believed(side_m, 0);
    drive_believed(0, sign * kPi / 2);
  }
  EXPECT_NEAR(robot.odometry.T_odom_body().x_m, 0, 1e-4) << "the odometry sees a closed square";
  EXPECT_NEAR(robot.odometry.T_odom_body().y_m, 0, 1e-4);
  return {robot.T_world_body.x_m, robot.T_world_body.y_m};
}

TEST(Odometry, UmbmarkRecoversTheSystematicErrors) {
  OdometryModel model;
  model.noise_m_per_sqrt_m = 0;
  const double L = 4;
  const double x_ccw = umbmark_end_m(model, L, 1).x(), x_cw = umbmark_end_m(model, L, -1).x();

  // Borenstein and Feng 1996: the track error turns both squares alike, unequal wheels bend them apart.
  const double alpha_rad = (x_cw + x_ccw) / (-4 * L);
  const double beta_rad = (x_cw - x_ccw) / (-4 * L);
  const double R = (L / 2) / std::sin(beta_rad / 2);
  const double E_d = (R + kDrive.track_m / 2) / (R - kDrive.track_m / 2);
  const double E_b = (kPi / 2) / (kPi / 2 - alpha_rad);
  EXPECT_NEAR(E_d, 1.002, 0.0002);
  EXPECT_NEAR(E_b, 1.02, 0.002);
}

TEST(Odometry, NoiseGrowsWithTheSquareRootOfTheWay) {
  OdometryModel model = kExact;
  model.noise_m_per_sqrt_m = 0.005;
  // each wheel errs by 0.005 sqrt(4) m over 4 m: the mean of both by 7.07 mm, the heading by 0.01 sqrt(2) /
  // 0.33 rad
  double way2 = 0, yaw2 = 0;
  const int runs = 400;
  for (int seed = 0; seed < runs; ++seed) {
    Rolling robot(model, static_cast<uint64_t>(seed));
    robot.drive(4, 0, 40 + seed % 100);  // whatever the number of updates
    way2 += std::pow(robot.odometry.T_odom_body().x_m - 4, 2);
    yaw2 += std::pow(robot.odometry.T_odom_body().yaw_rad, 2);
  }
  EXPECT_NEAR(std::sqrt(yaw2 / runs), 0.01 * std::sqrt(2) / 0.33, 0.12 * 0.0429)
      << "3.4 sigma of the estimate";
  EXPECT_LT(std::sqrt(way2 / runs), 0.0095);
  EXPECT_GT(std::sqrt(way2 / runs), 0.0060);
}

TEST(Odometry, NoiseIsAFunctionOfSeedAndUpdate) {
  const auto end = [](uint64_t seed) {
    Rolling robot(OdometryModel{}, seed);
    robot.drive(1, 0.5, 50);
    return robot.odometry.T_odom_body();
  };
  EXPECT_EQ(end(3).x_m, end(3).x_m);
  EXPECT_EQ(end(3).yaw_rad, end(3).yaw_rad);
  EXPECT_NE(end(3).yaw_rad, end(4).yaw_rad);

  // a copy continues as the original
  Rolling robot{OdometryModel{}};
  robot.drive(1, 0, 10);
  Rolling copy = robot;
  robot.drive(1, 1, 10);
  copy.drive(1, 1, 10);
  EXPECT_EQ(copy.odometry.T_odom_body().yaw_rad, robot.odometry.T_odom_body().yaw_rad);
}

TEST(Odometry, StandingStillAddsNoNoise) {
  Odometry odometry(OdometryModel{}, kDrive, 1, 2, 3);
  for (int i = 0; i < 100; ++i) odometry.update(2, 3);
  EXPECT_EQ(odometry.T_odom_body().x_m, 0);
  EXPECT_EQ(odometry.T_odom_body().yaw_rad, 0);
}

}  // namespace
}  // namespace groundloop::sim
