#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sim/scenario/fault.h"

namespace groundloop::sim {

/// What happens to one camera's image between the scene and the sensor, in place, before the sensor's noise:
/// blur and dirt of the lens, then light (flash, exposure, blackout). Depends on (faults, seed, camera, time)
/// alone.
/// @param camera        0 left, 1 right
/// @param image         grey values (CV_8UC1), which end at 255, or light on a sensor (CV_32FC1), which does
/// not
/// @param pixels_per_px of this image per delivered pixel, in which faults are told
void apply_image_faults(const std::vector<Fault>& faults, uint64_t seed, int camera, double time_s,
                        cv::Mat& image, int pixels_per_px = 1);

}  // namespace groundloop::sim
