#pragma once

#include <vector>

namespace groundloop::bench {

/// Statistics of a list of errors, in the errors' unit (sse in its square).
struct Statistics {
  double rmse = 0;  ///< root of the mean square
  double mean = 0;
  double median = 0;  ///< of an even count: mean of the middle two
  double std = 0;     ///< of the whole population (divides by n)
  double min = 0;
  double max = 0;
  double sse = 0;  ///< sum of squares
};

/// @param errors at least one, in any order
/// @throws std::invalid_argument when there is none
Statistics statistics(std::vector<double> errors);

}  // namespace groundloop::bench
