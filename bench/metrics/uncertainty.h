#pragma once

#include <cstdint>
#include <optional>

#include "bench/metrics/metrics.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// Normalised estimation error squared of a pose: e^T P^-1 e with e = log(T_estimate^-1 T_truth), for a
/// covariance P of right perturbations (translation, rotation). Of an honest P its mean is 6.
/// @return none when the covariance is not positive definite
/// @see Bar-Shalom, Li & Kirubarajan, Estimation with Applications to Tracking and Navigation, section 5.4
std::optional<double> nees(const slam::Pose& T_estimate, const slam::Matrix6d& covariance,
                           const slam::Pose& T_truth);

/// Sum of such errors over many poses, or over runs with several seeds.
struct NeesSum {
  double sum = 0;
  int64_t samples = 0;

  void add(const std::optional<double>& value) {
    if (!value) return;
    sum += *value;
    ++samples;
  }
  /// uncertainty.nees_mean, uncertainty.nees_samples; absent without samples
  Metrics metrics() const;
};

/// Within these bounds lies the mean of `samples` independent NEES of dimension 6, if the covariances are
/// honest, with a probability of 95 %. Too large a mean: too sure of itself; too small: too modest.
struct NeesBounds {
  double low = 0;
  double high = 0;
};
/// @param samples  at least 1
NeesBounds nees_bounds(int64_t samples);

/// Quantile of the chi-square distribution by Wilson & Hilferty's approximation (PNAS 17, 1931): within 3 %
/// at 6 degrees of freedom, within 0.05 % at 100.
/// @param normal_quantile  the quantile of the standard normal distribution at the same probability
double chi_square_quantile(double normal_quantile, double degrees_of_freedom);

}  // namespace groundloop::bench
