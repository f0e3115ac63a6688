#include "sim/head/counter_noise.h"

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

/// Standard normal quantile by bisection of erfc: slow, exact to double precision, run once for the table.
double normal_quantile(double probability) {
  double low = -10, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

const std::array<float, kQuantiles>& normal_quantiles() {
  static const std::array<float, kQuantiles> table = [] {
    std::array<double, kQuantiles> exact{};
    double square_sum = 0;
    for (int i = 0; i < kQuantiles; ++i) {
      exact[i] = normal_quantile((i + 0.5) / kQuantiles);
      square_sum += exact[i] * exact[i];
    }
    std::array<float, kQuantiles> scaled{};
    for (int i = 0; i < kQuantiles; ++i) {
      scaled[i] = static_cast<float>(exact[i] / std::sqrt(square_sum / kQuantiles));
    }
    return scaled;
  }();
  return table;
}

}  // namespace groundloop::sim
