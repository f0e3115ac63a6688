#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "bench/report/footprint.h"

namespace groundloop::bench {

/// Model of the scene and planned trajectory from above (paper Fig. 5), 1600 px wide, BGR. The start is
/// marked with its heading, the path with arrows.
/// @param outline  footprints of the scene, world frame
/// @param path     planned body poses in order, world frame; may be empty
/// @param start    body pose at the start
cv::Mat draw_preview(const std::vector<Footprint>& outline, const std::vector<PlanPose>& path,
                     const PlanPose& start);

}  // namespace groundloop::bench
