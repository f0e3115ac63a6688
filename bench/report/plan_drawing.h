#pragma once

#include <string>
#include <vector>

#include "bench/report/canvas.h"
#include "bench/report/footprint.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

// What the pictures seen from above have in common.

/// Position and heading of a camera: where its optical axis points on the floor. The frame must have z up.
PlanPose heading_of_camera(const slam::Pose& T_frame_left);

/// Footprints, the large ones below; with names where they fit.
void draw_outline(Canvas& canvas, const PlanView& view, std::vector<Footprint> outline, bool with_names);

/// A dot for position and a segment of `length_px` for heading.
void draw_heading(Canvas& canvas, const PlanView& view, const PlanPose& pose, double length_px,
                  Colour colour);

void draw_path(Canvas& canvas, const PlanView& view, const slam::Trajectory& trajectory, Colour colour,
               double width);

/// A ring with a name beside it, above or below.
void draw_place(Canvas& canvas, const PlanView& view, const PlanPose& pose, const std::string& name,
                Colour colour, bool name_below);

}  // namespace groundloop::bench
