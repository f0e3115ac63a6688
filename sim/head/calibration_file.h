#pragma once

#include <string>

#include "sim/head/head.h"

namespace groundloop::sim {

/// What the core is told of a raw head: the text of a stereo calibration file as OpenCV's stereo_calib writes
/// it (image_width, image_height, M1, D1, M2, D2, R, T with x_right = R x_left + T), with the head's
/// calibration error. Requires head.raw.
std::string calibration_yaml(const HeadModel& head);

}  // namespace groundloop::sim
