#include "sim/render/culling.h"

#include <algorithm>

namespace groundloop::sim {

std::array<HalfSpace, 4> view_pyramid(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& R_world_camera,
                                      const std::array<double, 4>& tangents) {
  const auto [left, right, top, bottom] = tangents;
  const auto side = [&](const Eigen::Vector3d& n_camera) {
    const Eigen::Vector3d n = R_world_camera * n_camera.normalized();
    return HalfSpace{n, n.dot(p_world)};
  };
  return {side({1, 0, -left}), side({-1, 0, right}), side({0, 1, -top}), side({0, -1, bottom})};
}

bool may_be_seen(const Eigen::Vector3d& centre_world, double radius_m,
                 const std::array<HalfSpace, 4>& pyramid, const std::vector<HalfSpace>& mirrors) {
  const auto touches = [&](const Eigen::Vector3d& centre) {
    return std::all_of(pyramid.begin(), pyramid.end(),
                       [&](const HalfSpace& side) { return side.depth_m(centre) >= -radius_m; });
  };
  if (touches(centre_world)) return true;
  return std::any_of(mirrors.begin(), mirrors.end(), [&](const HalfSpace& mirror) {
    return touches(centre_world - 2 * mirror.depth_m(centre_world) * mirror.n);
  });
}

}  // namespace groundloop::sim
