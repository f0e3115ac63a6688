#include "sim/arm/arm_kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

const ArmGeometry kUr5e = {0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996};
constexpr double kTurn = 2 * std::numbers::pi;

JointAngles random_angles(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  JointAngles q;
  for (int i = 0; i < 6; ++i) q[i] = angle(random);
  return q;
}

/// The maker's table multiplied out by hand for a few angles.
TEST(ArmKinematics, StretchedAlongMinusXAtZero) {
  const slam::Pose T = forward_kinematics(kUr5e, JointAngles::Zero());
  EXPECT_LT((T.translation() - Eigen::Vector3d(-0.425 - 0.3922, -0.1333 - 0.0996, 0.1625 - 0.0997)).norm(),
            1e-12);
  EXPECT_LT((T.linear().col(2) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);  // the hand points along -y
}

TEST(ArmKinematics, UprightWithTheShoulderLiftedByAQuarter) {
  JointAngles q = JointAngles::Zero();
  q[1] = -std::numbers::pi / 2;
  const slam::Pose T = forward_kinematics(kUr5e, q);
  EXPECT_NEAR(T.translation().z(), 0.1625 + 0.425 + 0.3922, 1e-12);
  EXPECT_NEAR(T.translation().x(), 0.0997 * -1, 1e-12);
}

TEST(ArmKinematics, TheBaseTurnsEverythingAboutZ) {
  std::mt19937 random(3);
  const JointAngles q = random_angles(random);
  JointAngles turned = q;
  turned[0] += 0.4;
  const slam::Pose expected = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * forward_kinematics(kUr5e, q);
  EXPECT_TRUE(forward_kinematics(kUr5e, turned).isApprox(expected, 1e-12));
}

TEST(ArmKinematics, EverySolutionReachesThePose) {
  std::mt19937 random(1);
  int eight = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const JointAngles q = random_angles(random);
    const slam::Pose T = forward_kinematics(kUr5e, q);
    const InverseKinematics inverse = inverse_kinematics(kUr5e, {}, T, JointAngles::Zero());
    for (const JointAngles& solution : inverse.solutions) {
      EXPECT_LT(slam::se3_log(T.inverse() * forward_kinematics(kUr5e, solution)).norm(), 1e-9)
          << q.transpose();
    }
    eight += inverse.solutions.size() == 8 ? 1 : 0;
  }
  EXPECT_GT(eight, 1000);  // the other poses are near a limit of the reach
}

/// Nothing is lost: the angles that the pose was made of are among the answers.
TEST(ArmKinematics, TheAnglesOfAPoseAreAmongItsSolutions) {
  std::mt19937 random(2);
  int asked = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const JointAngles q = random_angles(random);
    const double elbow = std::abs(std::remainder(q[2], kTurn));
    if (elbow < 0.1 || elbow > std::numbers::pi - 0.1 || std::abs(std::sin(q[4])) < 0.01) continue;
    ++asked;
    const auto solutions = inverse_kinematics(kUr5e, {}, forward_kinematics(kUr5e, q), q).solutions;
    const bool found = std::any_of(solutions.begin(), solutions.end(), [&](const JointAngles& s) {
      return (s - q).cwiseAbs().maxCoeff() < 1e-7;
    });
    EXPECT_TRUE(found) << q.transpose();
  }
  EXPECT_GT(asked, 1500);
}

TEST(ArmKinematics, AnglesAreInTheTurnNearestToWhereTheArmIs) {
  JointAngles q, near;
  q << 0.4, -1.2, 1.0, -0.8, 1.3, 0.6;
  near = q;
  near[0] += kTurn;
  near[5] -= kTurn;
  const auto solutions = inverse_kinematics(kUr5e, {}, forward_kinematics(kUr5e, q), near).solutions;
  const bool found = std::any_of(solutions.begin(), solutions.end(), [&](const JointAngles& s) {
    return (s - near).cwiseAbs().maxCoeff() < 1e-9;
  });
  EXPECT_TRUE(found);
}

TEST(ArmKinematics, LimitsTurnAnAngleBackOrRefuseIt) {
  JointAngles q;
  q << 0.4, -1.2, 1.0, -0.8, 1.3, 0.6;
  const slam::Pose T = forward_kinematics(kUr5e, q);
  JointLimits limits;
  limits.low.setConstant(-std::numbers::pi);
  limits.high.setConstant(std::numbers::pi);
  for (const JointAngles& s : inverse_kinematics(kUr5e, limits, T, JointAngles::Constant(6)).solutions) {
    EXPECT_LE(s.cwiseAbs().maxCoeff(), std::numbers::pi);
  }
  limits.low[0] = 2.9;  // no shoulder of this pose is there
  const InverseKinematics refused = inverse_kinematics(kUr5e, limits, T, q);
  EXPECT_TRUE(refused.solutions.empty());
  EXPECT_THAT(refused.reason, HasSubstr("joint 1 would have to turn to"));
}

/// With the hand down the wrist is above the flange; the arm's reach then is a circle in the plane.
TEST(ArmKinematics, OutOfReachIsToldInMillimetres) {
  slam::Pose T = slam::Pose::Identity();
  T.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T.translation() << 2, 0, 0.1625 - 0.0996;  // wrist at the height of the shoulder
  const InverseKinematics far = inverse_kinematics(kUr5e, {}, T, JointAngles::Zero());
  EXPECT_TRUE(far.solutions.empty());
  const double across_m =
      std::sqrt(4 - 0.1333 * 0.1333) - 0.0997;  // of both ways to hold the wrist, the one that helps
  const double reach_m =
      std::sqrt(0.425 * 0.425 + 0.3922 * 0.3922 + 2 * 0.425 * 0.3922 * std::cos(kLeastElbow_rad));
  char expected[32];
  std::snprintf(expected, sizeof expected, "%.1f mm beyond", 1e3 * (across_m - reach_m));
  EXPECT_THAT(far.reason, HasSubstr(expected));

  T.translation() << 0.05, 0.02, 0.3;
  EXPECT_THAT(inverse_kinematics(kUr5e, {}, T, JointAngles::Zero()).reason,
              HasSubstr("too near to the axis of the base"));
}

TEST(ArmKinematics, WithParallelWristAxesTheLastJointStays) {
  JointAngles q;
  q << 0.4, -1.2, 1.0, -0.8, 0, 0.6;
  const slam::Pose T = forward_kinematics(kUr5e, q);
  JointAngles near = q;
  near[5] = 0.25;
  const auto solutions = inverse_kinematics(kUr5e, {}, T, near).solutions;
  ASSERT_FALSE(solutions.empty());
  int stayed = 0;
  for (const JointAngles& s : solutions) {
    EXPECT_LT(slam::se3_log(T.inverse() * forward_kinematics(kUr5e, s)).norm(), 1e-7);
    stayed += std::abs(s[5] - 0.25) < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(stayed, 0);
}

}  // namespace
}  // namespace groundloop::sim
