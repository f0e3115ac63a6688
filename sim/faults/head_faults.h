#pragma once

#include <vector>

#include "sim/scenario/fault.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// Time [s] by which the right camera exposes after the left one; the sum of what is active.
double trigger_offset_s(const std::vector<Fault>& faults, double time_s);

/// Pose of the right camera as it is, seen from where the calibration says it is: knocks turn it about its
/// own centre (pan to the left, then tilt up, then roll).
slam::Pose T_calibrated_right(const std::vector<Fault>& faults, double time_s);

}  // namespace groundloop::sim
