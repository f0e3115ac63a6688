#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "bench/report/footprint.h"

namespace groundloop::bench {

/// A person's way, in the world frame [m].
struct DrawnWalk {
  std::string name;
  std::vector<Eigen::Vector2d> way;  ///< corners; one alone: stands there
  bool back_and_forth = false;
};

/// Furniture that is put elsewhere: one thing, where it stood and where it stands from `at_s` on.
struct DrawnMove {
  double at_s = 0;
  std::vector<Footprint> from, to;  ///< the same geoms
};

/// The robot is put elsewhere, and its plan goes on from there.
struct DrawnKidnapping {
  double at_s = 0;
  PlanPose from;
  std::vector<PlanPose> path;  ///< from where it is put down to the next time, or the end
};

/// What happens in a scenario beside the plan, in order of time.
struct DrawnEvents {
  std::vector<DrawnWalk> people;
  std::vector<DrawnMove> moves;
  std::vector<DrawnKidnapping> kidnappings;
};

/// Model of the scene and planned trajectory from above (paper Fig. 5), 1600 px wide, BGR. The start is
/// marked with its heading, the path with arrows. The legend names what there is.
/// @param outline  footprints of the scene at the start, world frame
/// @param path     planned body poses in order, up to a kidnapping, world frame; may be empty
/// @param start    body pose at the start
cv::Mat draw_preview(const std::vector<Footprint>& outline, const std::vector<PlanPose>& path,
                     const PlanPose& start, const DrawnEvents& events = {});

}  // namespace groundloop::bench
