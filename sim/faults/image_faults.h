#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sim/scenario/fault.h"

namespace groundloop::sim {

/// What happens to one camera's image (CV_8UC1) between the scene and the sensor, in place, before the
/// sensor's noise: blur and dirt of the lens, then light (flash, exposure, blackout). Grey values end at 255.
/// Depends on (faults, seed, camera, time) alone.
/// @param camera  0 left, 1 right
void apply_image_faults(const std::vector<Fault>& faults, uint64_t seed, int camera, double time_s,
                        cv::Mat& image);

}  // namespace groundloop::sim
