#pragma once

#include "slam/types/pose.h"

namespace groundloop::sim {

/// A pose on the floor. The heading is not wrapped: it counts whole turns.
struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;
};

/// Pose after driving `length_m` along a circle while turning by `turn_rad`; exact for straights, arcs and
/// turns on the spot.
Pose2 driven(const Pose2& from, double length_m, double turn_rad);

/// T_a_c of T_a_b and T_b_c.
Pose2 composed(const Pose2& T_a_b, const Pose2& T_b_c);
/// T_b_a of T_a_b.
Pose2 inverse(const Pose2& T_a_b);

slam::Pose to_pose(const Pose2& T_a_b);

/// Position and heading of a pose in space; the heading is in (-pi, pi].
Pose2 to_pose2(const slam::Pose& T_a_b);

/// The same angle in [-pi, pi].
double wrapped(double angle_rad);

}  // namespace groundloop::sim
