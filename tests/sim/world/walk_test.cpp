#include "sim/world/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kPi = std::numbers::pi;

/// 2 m along x, then 3 m along y, from 10 s on at 0.5 m/s.
Person walker() {
  Person person;
  person.at_s = 10;
  person.speed_mps = 0.5;
  person.way = {{1, 0}, {3, 0}, {3, 3}};
  return person;
}

TEST(Walk, StandsBeforeAndAfter) {
  const Walk walk(walker());
  EXPECT_NEAR(walk.length_m(), 5, 1e-12);
  for (const double time_s : {0.0, 10.0}) {
    EXPECT_TRUE(walk.at(time_s).p_world.isApprox(Eigen::Vector2d(1, 0)));
    EXPECT_EQ(walk.at(time_s).swing_rad, 0);
    EXPECT_NEAR(walk.at(time_s).yaw_rad, 0, 1e-12) << "looks where it will go";
  }
  EXPECT_TRUE(walk.at(1000).p_world.isApprox(Eigen::Vector2d(3, 3)));
  EXPECT_EQ(walk.at(1000).swing_rad, 0);
  EXPECT_NEAR(walk.at(1000).yaw_rad, kPi / 2, 1e-12);
}

TEST(Walk, WalksAtItsSpeedAndRoundsCorners) {
  const Walk walk(walker());
  EXPECT_TRUE(walk.at(12).p_world.isApprox(Eigen::Vector2d(2, 0)));
  EXPECT_TRUE(walk.at(16).p_world.isApprox(Eigen::Vector2d(3, 1)));
  EXPECT_NEAR(walk.at(14).yaw_rad, kPi / 4, 1e-9) << "half way round the corner";
}

TEST(Walk, BackAndForthItTurnsRoundAtTheEnds) {
  Person person = walker();
  person.back_and_forth = true;
  const Walk walk(person);
  // 10 s there, 10 s back
  EXPECT_TRUE(walk.at(10 + 14).p_world.isApprox(walk.at(10 + 6).p_world, 1e-9));
  EXPECT_NEAR(std::abs(std::remainder(walk.at(10 + 14).yaw_rad - walk.at(10 + 6).yaw_rad, 2 * kPi)), kPi,
              1e-9);
  EXPECT_TRUE(walk.at(10 + 20 + 3).p_world.isApprox(walk.at(10 + 3).p_world, 1e-9));
}

TEST(Walk, LegsSwingOneStrideAPeriod) {
  const Walk walk(walker());
  const double stride_s = 1.3 / 0.5;
  EXPECT_NEAR(walk.at(12).swing_rad, walk.at(12 + stride_s).swing_rad, 1e-9);
  EXPECT_NEAR(walk.at(12).swing_rad, -walk.at(12 + stride_s / 2).swing_rad, 1e-9);
  double most_rad = 0;
  for (double t = 12; t < 12 + stride_s; t += 0.01) most_rad = std::max(most_rad, walk.at(t).swing_rad);
  EXPECT_NEAR(most_rad, 24 * kPi / 180, 0.001);
}

TEST(Walk, SomeoneWithOnePointStandsThere) {
  Person person = walker();
  person.way = {{4, 5}};
  person.back_and_forth = true;
  EXPECT_TRUE(Walk(person).at(50).p_world.isApprox(Eigen::Vector2d(4, 5)));
}

}  // namespace
}  // namespace groundloop::sim
