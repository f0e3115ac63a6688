#pragma once

#include <Eigen/Geometry>

#include "sim/truth/solid.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// A body, known in a frame of its own, as seen from the world.
Support moved(Support local, const slam::Pose& T_world_local);

/// All points within margin_m of a body.
Support enlarged(Support body, double margin_m);

/// The axis-aligned box around a body.
Eigen::AlignedBox3d extent_of(const Support& body);

/// Whether two convex bodies of the same frame have a point in common: Bullet's GJK on exact support
/// functions.
/// @param guess  direction from b to a, roughly
bool overlap(const Support& a, const Support& b, const Eigen::Vector3d& guess);

}  // namespace groundloop::sim
