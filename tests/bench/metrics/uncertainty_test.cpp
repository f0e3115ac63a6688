#include "bench/metrics/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "slam/types/counter_random.h"
#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using slam::Matrix6d;
using slam::Pose;
using slam::Vector6d;

/// Standard normal number of a counter (Box and Muller).
double normal(uint64_t counter) {
  const auto uniform = [](uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1.0p-53; };
  const double a = uniform(random_bits(7, 0, counter)), b = uniform(random_bits(7, 1, counter));
  return std::sqrt(-2 * std::log(a)) * std::cos(2 * std::numbers::pi * b);
}

/// Millimetres and tenths of a degree, all correlated.
Matrix6d some_covariance() {
  Matrix6d root = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) root(i, j) = (i == j ? 3e-3 : 1e-3 * std::sin(i * 7 + j));
  }
  return root * root.transpose();
}

TEST(Nees, IsTheSquareInStandardDeviations) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 1e-4, 4e-4, 9e-4, 1e-6, 4e-6, 9e-6;
  const Pose T_truth = turned(30, {1, 2, 3}) * moved(1, 2, 3);
  Vector6d error;
  error << 0.02, 0, 0, 0, 0, 0;  // two standard deviations
  EXPECT_NEAR(*nees(T_truth * slam::se3_exp(error).inverse(), covariance, T_truth), 4, 1e-9);
  error << 0, 0, 0, 0, 0.006, 0;  // three
  EXPECT_NEAR(*nees(T_truth * slam::se3_exp(error).inverse(), covariance, T_truth), 9, 1e-9);
  EXPECT_NEAR(*nees(T_truth, covariance, T_truth), 0, 1e-20);
  EXPECT_FALSE(nees(T_truth, Matrix6d::Zero(), T_truth)) << "not a covariance";
}

TEST(Nees, OfHonestCovariancesLiesWithinTheBounds) {
  constexpr int64_t kSamples = 4000;
  const Matrix6d covariance = some_covariance();
  const Matrix6d root = Eigen::LLT<Matrix6d>(covariance).matrixL();
  NeesSum honest, proud, modest;
  for (int64_t k = 0; k < kSamples; ++k) {
    const Pose T_estimate = turned(static_cast<double>(k), {1, 0, 1}) * moved(1, 0, 0);
    Vector6d unit;
    for (int i = 0; i < 6; ++i) unit[i] = normal(static_cast<uint64_t>(6 * k + i));
    const Pose T_truth = T_estimate * slam::se3_exp(root * unit);
    honest.add(nees(T_estimate, covariance, T_truth));
    proud.add(nees(T_estimate, covariance / 1.2, T_truth));
    modest.add(nees(T_estimate, covariance * 1.2, T_truth));
  }
  const NeesBounds bounds = nees_bounds(kSamples);
  const auto mean = [](const NeesSum& sum) { return sum.metrics().at("uncertainty.nees_mean"); };
  EXPECT_GT(mean(honest), bounds.low);
  EXPECT_LT(mean(honest), bounds.high);
  EXPECT_GT(mean(proud), bounds.high);
  EXPECT_LT(mean(modest), bounds.low);
  EXPECT_EQ(honest.metrics().at("uncertainty.nees_samples"), kSamples);
}

TEST(Nees, WithoutSamplesSaysNothing) {
  NeesSum sum;
  sum.add(std::nullopt);
  EXPECT_TRUE(sum.metrics().empty());
}

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  constexpr double k97_5 = 1.959963984540054;
  EXPECT_NEAR(chi_square_quantile(k97_5, 6), 14.449, 0.02);
  EXPECT_NEAR(chi_square_quantile(-k97_5, 6), 1.237, 0.035);
  EXPECT_NEAR(chi_square_quantile(k97_5, 100), 129.561, 0.01);
  EXPECT_NEAR(chi_square_quantile(-k97_5, 100), 74.222, 0.01);
  const NeesBounds bounds = nees_bounds(1);
  EXPECT_EQ(bounds.high, chi_square_quantile(k97_5, 6));
  EXPECT_NEAR(nees_bounds(1000).high, 6 + 2 * std::sqrt(12.0 / 1000), 0.01);  // nearly normal: variance 2 * 6
}

}  // namespace
}  // namespace groundloop::bench
