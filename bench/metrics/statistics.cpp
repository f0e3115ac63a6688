#include "bench/metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace groundloop::bench {

Statistics statistics(std::vector<double> errors) {
  if (errors.empty()) throw std::invalid_argument("statistics of no errors");
  std::sort(errors.begin(), errors.end());
  const size_t n = errors.size();
  const auto count = static_cast<double>(n);

  Statistics s;
  s.min = errors.front();
  s.max = errors.back();
  s.median = n % 2 == 1 ? errors[n / 2] : (errors[n / 2 - 1] + errors[n / 2]) / 2;
  s.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  double squared_deviations = 0;
  for (const double error : errors) {
    s.sse += error * error;
    squared_deviations += (error - s.mean) * (error - s.mean);
  }
  s.rmse = std::sqrt(s.sse / count);
  s.std = std::sqrt(squared_deviations / count);
  return s;
}

}  // namespace groundloop::bench
