#pragma once

#include <map>
#include <string>

namespace groundloop::bench {

/// What was measured: dotted name (`trajectory.ate_rmse_m`) to number. A metric that could not be measured is
/// absent, never a made-up value.
using Metrics = std::map<std::string, double>;

/// One flat JSON object, keys sorted, one a line, numbers so that they read back exactly.
std::string to_json(const Metrics& metrics);

}  // namespace groundloop::bench
