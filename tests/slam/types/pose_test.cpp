#include "slam/types/pose.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace groundloop::slam {
namespace {

constexpr double kPi = std::numbers::pi;

/// Directions spread over the sphere, and the axes themselves.
std::vector<Eigen::Vector3d> directions() {
  return {Eigen::Vector3d::UnitX(),      -Eigen::Vector3d::UnitY(),     Eigen::Vector3d::UnitZ(),
          Eigen::Vector3d(1, 2, -2) / 3, Eigen::Vector3d(-2, 3, 6) / 7, Eigen::Vector3d(-4, -4, -7) / 9};
}

Vector6d twist(const Eigen::Vector3d& translation_m, const Eigen::Vector3d& rotation_rad) {
  Vector6d t;
  t << translation_m, rotation_rad;
  return t;
}

/// The exponential by its series, with the 4x4 twist matrix halved until the series converges fast.
Eigen::Matrix4d exp_by_series(const Vector6d& t) {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topLeftCorner<3, 3>() = skew(t.tail<3>());
  A.topRightCorner<3, 1>() = t.head<3>();
  A /= 64;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
  for (int n = 1; n < 20; ++n) term = term * A / n, sum += term;
  for (int i = 0; i < 6; ++i) sum = sum * sum;
  return sum;
}

class PoseAtAngle : public testing::TestWithParam<double> {};

TEST_P(PoseAtAngle, ExponentialEqualsItsSeries) {
  for (const Eigen::Vector3d& axis : directions()) {
    const Vector6d t = twist({0.3, -1.2, 2.5}, GetParam() * axis);
    EXPECT_LT((se3_exp(t).matrix() - exp_by_series(t)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_P(PoseAtAngle, LogarithmUndoesExponential) {
  for (const Eigen::Vector3d& axis : directions()) {
    const Vector6d t = twist({0.3, -1.2, 2.5}, GetParam() * axis);
    EXPECT_LT((se3_log(se3_exp(t)) - t).cwiseAbs().maxCoeff(), 1e-9) << "axis " << axis.transpose();
  }
}

TEST_P(PoseAtAngle, ExponentialOfOppositeIsInverse) {
  for (const Eigen::Vector3d& axis : directions()) {
    const Vector6d t = twist({-2, 0.1, 0.7}, GetParam() * axis);
    EXPECT_TRUE((se3_exp(t) * se3_exp(-t)).matrix().isIdentity(1e-11));
  }
}

TEST_P(PoseAtAngle, RotationIsARotationOfThatAngle) {
  for (const Eigen::Vector3d& axis : directions()) {
    const Eigen::Matrix3d R = so3_exp(GetParam() * axis);
    EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
    EXPECT_NEAR(rotation_angle_rad(R), GetParam(), 1e-9);
    EXPECT_LT((R * axis - axis).norm(), 1e-14);
  }
}

// Identity, both sides of the switch to the series (1e-4 rad), ordinary angles, and close below pi.
INSTANTIATE_TEST_SUITE_P(Angles, PoseAtAngle,
                         testing::Values(0.0, 1e-300, 1e-12, 1e-8, 0.99e-4, 1.01e-4, 1e-3, 0.5, 1.7, 3.0,
                                         kPi - 1e-3, kPi - 1e-6));

TEST(Pose, LogarithmAtHalfATurnHasAngleOfPiAndAnAxisUpToSign) {
  for (const Eigen::Vector3d& axis : directions()) {
    const Eigen::Vector3d rotation_rad = so3_log(so3_exp(kPi * axis));
    EXPECT_NEAR(rotation_rad.norm(), kPi, 1e-9);
    EXPECT_NEAR(std::abs(rotation_rad.normalized().dot(axis)), 1, 1e-9);
  }
}

TEST(Pose, LogarithmOfMoreThanHalfATurnGoesTheShorterWay) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  EXPECT_LT((so3_log(so3_exp((kPi + 0.2) * axis)) + (kPi - 0.2) * axis).norm(), 1e-9);
}

TEST(Pose, TwistAlongItsAxisIsAScrew) {
  // Half a turn about z on a circle of radius 2, risen by 1: the twist's translation is rotated as it goes.
  const Pose T = se3_exp(twist({kPi * 2, 0, 1}, {0, 0, kPi}));
  EXPECT_LT((T.translation() - Eigen::Vector3d(0, 4, 1)).norm(), 1e-12);
}

TEST(Pose, RandomMotionsObeyTheAdjointLaw) {
  // T exp(t) T^-1 = exp(Ad(T) t): seen from another frame the same screw has another twist.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.7, 1.7);
  for (int i = 0; i < 200; ++i) {
    Vector6d t, s;
    for (int k = 0; k < 6; ++k) t[k] = uniform(random), s[k] = uniform(random);
    const Pose T = se3_exp(s);
    const Vector6d moved = twist(T.linear() * t.head<3>() + skew(T.translation()) * T.linear() * t.tail<3>(),
                                 T.linear() * t.tail<3>());
    EXPECT_LT(((T * se3_exp(t) * T.inverse()).matrix() - se3_exp(moved).matrix()).cwiseAbs().maxCoeff(),
              1e-12);
    EXPECT_LT((se3_log(se3_exp(t)) - t).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Pose, SkewIsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(Pose, YawIsTheHeadingInTheHorizontalPlane) {
  EXPECT_NEAR(yaw_rad(so3_exp({0, 0, 0.7})), 0.7, 1e-15);
  EXPECT_NEAR(yaw_rad(so3_exp({0, 0, -3.1})), -3.1, 1e-15);
  // The order of yaw before pitch leaves the heading alone.
  EXPECT_NEAR(yaw_rad(so3_exp({0, 0, 2.0}) * so3_exp({0, 0.4, 0})), 2.0, 1e-15);
}

TEST(Pose, RenormalisedIsTheNearestRotation) {
  const Pose T = se3_exp(twist({1, 2, 3}, {0.4, -0.2, 0.9}));
  Pose drifted = T;
  drifted.linear() *= 1.01;  // a scaled rotation's nearest rotation is the rotation
  EXPECT_TRUE(renormalised(drifted).isApprox(T, 1e-14));
  drifted.linear() += 0.001 * Eigen::Matrix3d::Ones();
  const Eigen::Matrix3d R = renormalised(drifted).linear();
  EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
  EXPECT_GT(R.determinant(), 0);
  EXPECT_EQ(renormalised(drifted).translation(), T.translation());
}

}  // namespace
}  // namespace groundloop::slam
