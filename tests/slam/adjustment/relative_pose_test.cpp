#include "slam/adjustment/relative_pose.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

Vector6d random_twist(uint64_t seed, double length_m, double angle_rad) {
  Vector6d twist;
  for (int i = 0; i < 6; ++i) twist(i) = gaussian(seed, static_cast<uint64_t>(i), 1);
  twist.head<3>() *= length_m / twist.head<3>().norm();
  twist.tail<3>() *= angle_rad / twist.tail<3>().norm();
  return twist;
}

TEST(Se3Adjoint, MovesATwistToTheOtherEnd) {
  const Pose T_a_b = se3_exp(random_twist(1, 2, 1.5));
  const Vector6d twist = random_twist(2, 0.5, 0.7);
  const Pose left = T_a_b * se3_exp(twist), right = se3_exp(se3_adjoint(T_a_b) * twist) * T_a_b;
  EXPECT_LT((left.matrix() - right.matrix()).norm(), 1e-13);
}

TEST(Se3RightJacobianInverse, EqualsFiniteDifferencesForEveryAngle) {
  for (const double angle_rad : {0.0, 1e-8, 1e-3, 0.0999, 0.1001, 1.0, 2.5, std::numbers::pi - 0.01}) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      const Vector6d twist = random_twist(seed, 1.3, angle_rad);
      const Matrix6d J = se3_right_jacobian_inverse(twist);
      constexpr double kStep = 5e-5;
      for (int i = 0; i < 6; ++i) {
        const Vector6d d = kStep * Vector6d::Unit(i);
        const Vector6d numeric =
            (se3_log(se3_exp(twist) * se3_exp(d)) - se3_log(se3_exp(twist) * se3_exp(-d))) / (2 * kStep);
        EXPECT_LT((J.col(i) - numeric).norm(), 1e-8) << angle_rad << " rad, column " << i;
      }
    }
  }
}

TEST(Se3RightJacobianInverse, IsExactAlongItsOwnTwist) {
  // exp(x) exp(t x) = exp((1 + t) x): the Jacobian leaves x as it is.
  for (const double angle_rad : {1e-6, 0.05, 0.3, 3.1}) {
    const Vector6d twist = random_twist(7, 0.8, angle_rad);
    EXPECT_LT((se3_right_jacobian_inverse(twist) * twist - twist).norm(), 1e-13);
  }
}

TEST(RelativePoseError, IsZeroForTheTrueMotionAndItsJacobiansAreThoseOfFiniteDifferences) {
  const Pose T_odom_from = se3_exp(random_twist(3, 4, 2)), T_odom_to = se3_exp(random_twist(4, 3, 1));
  const Pose T_from_to = T_odom_from.inverse() * T_odom_to;
  EXPECT_LT(relative_pose_error(T_odom_from, T_odom_to, T_from_to).error.norm(), 1e-14);

  const Pose measured = T_from_to * se3_exp(random_twist(5, 0.7, 2.2));
  const RelativePoseError e = relative_pose_error(T_odom_from, T_odom_to, measured);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 6; ++i) {
    const Pose ahead = se3_exp(kStep * Vector6d::Unit(i)), back = ahead.inverse();
    const Vector6d by_from = relative_pose_error(T_odom_from * ahead, T_odom_to, measured).error -
                             relative_pose_error(T_odom_from * back, T_odom_to, measured).error;
    const Vector6d by_to = relative_pose_error(T_odom_from, T_odom_to * ahead, measured).error -
                           relative_pose_error(T_odom_from, T_odom_to * back, measured).error;
    EXPECT_LT((e.J_from.col(i) - by_from / (2 * kStep)).norm(), 1e-8);
    EXPECT_LT((e.J_to.col(i) - by_to / (2 * kStep)).norm(), 1e-8);
  }
}

TEST(RelativePoseCovariance, EqualsThatOfSamples) {
  // Two poses with common noise: what they share, expressed at each, cancels.
  const Pose T_a_b = se3_exp(random_twist(4, 1, 0.8));
  const Matrix6d S_aa = Vector6d(1e-6 * Vector6d::LinSpaced(1, 6)).asDiagonal();
  const Matrix6d Ad = se3_adjoint(T_a_b.inverse());
  const Matrix6d S_own = Vector6d(2e-6 * Vector6d::LinSpaced(6, 1)).asDiagonal();
  const Matrix6d S_ab = S_aa * Ad.transpose(), S_bb = Ad * S_aa * Ad.transpose() + S_own;
  EXPECT_LT((relative_pose_covariance(T_a_b, S_aa, S_ab, S_bb) - S_own).norm(), 1e-18);

  // Independent ends: samples of the relative pose.
  Matrix6d sum = Matrix6d::Zero();
  constexpr int kSamples = 4000;
  for (uint64_t n = 0; n < kSamples; ++n) {
    Vector6d at_a, at_b;
    for (int i = 0; i < 6; ++i) {
      at_a(i) = std::sqrt(S_aa(i, i)) * gaussian(n, static_cast<uint64_t>(i), 2);
      at_b(i) = std::sqrt(S_own(i, i)) * gaussian(n, static_cast<uint64_t>(i), 3);
    }
    const Pose noisy = se3_exp(at_a).inverse() * T_a_b * se3_exp(at_b);
    const Vector6d e = se3_log(T_a_b.inverse() * noisy);
    sum += e * e.transpose();
  }
  const Matrix6d expected = relative_pose_covariance(T_a_b, S_aa, Matrix6d::Zero(), S_own);
  EXPECT_LT((sum / kSamples - expected).norm(), 0.05 * expected.norm());
}

}  // namespace
}  // namespace groundloop::slam
