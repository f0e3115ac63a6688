#pragma once

#include <vector>

#include "slam/types/pose.h"

namespace groundloop::bench {

/// Path travelled from the first pose up to each [m]; as long as the trajectory, beginning with 0.
std::vector<double> travelled(const slam::Trajectory& poses);

}  // namespace groundloop::bench
