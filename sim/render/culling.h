#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <vector>

namespace groundloop::sim {

/// A half-space n.p >= offset; n has unit length.
struct HalfSpace {
  Eigen::Vector3d n;
  double offset_m;

  double depth_m(const Eigen::Vector3d& p) const { return n.dot(p) - offset_m; }
};

/// The pyramid that an image sees: its four sides, in the world frame.
/// @param tangents  x/z of the left and right edge, y/z of the upper and lower edge in the camera (y down)
std::array<HalfSpace, 4> view_pyramid(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& R_world_camera,
                                      const std::array<double, 4>& tangents);

/// Whether a sphere touches the pyramid, or its image in one of the mirrors does. May say yes to a sphere
/// near an edge that does not, never no to one that does.
bool may_be_seen(const Eigen::Vector3d& centre_world, double radius_m,
                 const std::array<HalfSpace, 4>& pyramid, const std::vector<HalfSpace>& mirrors);

}  // namespace groundloop::sim
