#include "bench/metrics/uncertainty.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace groundloop::bench {
namespace {

constexpr double kDimension = 6;
constexpr double kNormal95 = 1.959963984540054;  // of both sides together 5 % lie beyond

}  // namespace

std::optional<double> nees(const slam::Pose& T_estimate, const slam::Matrix6d& covariance,
                           const slam::Pose& T_truth) {
  const Eigen::LLT<slam::Matrix6d> factor(covariance);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const slam::Vector6d error = slam::se3_log(T_estimate.inverse() * T_truth);
  return error.dot(factor.solve(error));
}

Metrics NeesSum::metrics() const {
  if (samples == 0) return {};
  return {{"uncertainty.nees_mean", sum / static_cast<double>(samples)},
          {"uncertainty.nees_samples", static_cast<double>(samples)}};
}

NeesBounds nees_bounds(int64_t samples) {
  const auto n = static_cast<double>(samples);
  return {chi_square_quantile(-kNormal95, kDimension * n) / n,
          chi_square_quantile(kNormal95, kDimension * n) / n};
}

double chi_square_quantile(double normal_quantile, double degrees_of_freedom) {
  const double spread = 2 / (9 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1 - spread + normal_quantile * std::sqrt(spread), 3);
}

}  // namespace groundloop::bench
