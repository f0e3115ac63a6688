#include "bench/metrics/truth/sight.h"

#include <cmath>

namespace groundloop::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kViewColumns = 16;
constexpr int kViewRows = 12;
constexpr double kHiding_m = 0.005;  // a surface does not hide itself, whatever the rounding

/// An image reaches half a pixel beyond the centres of its first and last pixels.
bool inside(const slam::StereoRig& rig, const Vector2d& px) {
  return px.x() >= -0.5 && px.y() >= -0.5 && px.x() < rig.width_px - 0.5 && px.y() < rig.height_px - 0.5;
}

}  // namespace

std::optional<Vector3d> Sight::surface(const slam::Pose& T_world_left, const Vector2d& uv_left_px) const {
  const auto depth_m = scene_.depth_m(rig_, T_world_left, uv_left_px.x(), uv_left_px.y());
  if (!depth_m) return std::nullopt;
  const Vector3d ray_left((uv_left_px.x() - rig_.cx_px) / rig_.fx_px,
                          (uv_left_px.y() - rig_.cy_px) / rig_.fy_px, 1);
  return T_world_left * Vector3d(*depth_m * ray_left);
}

std::optional<Vector2d> Sight::left_px(const slam::Pose& T_world_left, const Vector3d& p_world) const {
  const Vector3d p_left = T_world_left.inverse() * p_world;
  if (p_left.z() <= 0) return std::nullopt;
  const Vector2d px = rig_.project(p_left).head<2>();
  if (!inside(rig_, px) || hidden(T_world_left.translation(), p_world)) return std::nullopt;
  return px;
}

std::optional<Vector2d> Sight::right_px(const slam::Pose& T_world_left, const Vector3d& p_world) const {
  const Vector3d p_left = T_world_left.inverse() * p_world;
  if (p_left.z() <= 0) return std::nullopt;
  const Vector3d uvu = rig_.project(p_left);
  const Vector2d px(uvu.z(), uvu.y());
  if (!inside(rig_, px)) return std::nullopt;
  if (hidden(T_world_left * Vector3d(rig_.baseline_m, 0, 0), p_world)) return std::nullopt;
  return px;
}

std::vector<Vector3d> Sight::view(const slam::Pose& T_world_left) const {
  std::vector<Vector3d> points;
  for (int j = 0; j < kViewRows; ++j) {
    for (int i = 0; i < kViewColumns; ++i) {
      const Vector2d px((i + 0.5) * rig_.width_px / kViewColumns - 0.5,
                        (j + 0.5) * rig_.height_px / kViewRows - 0.5);
      if (const auto p_world = surface(T_world_left, px)) points.push_back(*p_world);
    }
  }
  return points;
}

double Sight::share_seen(const std::vector<Vector3d>& view_world, const slam::Pose& T_world_left,
                         double enough) const {
  if (view_world.empty()) return 0;
  const auto all = static_cast<double>(view_world.size());
  const slam::Pose T_left_world = T_world_left.inverse();
  std::vector<Vector3d> in_image;
  for (const Vector3d& p_world : view_world) {
    const Vector3d p_left = T_left_world * p_world;
    if (p_left.z() > 0 && inside(rig_, rig_.project(p_left).head<2>())) in_image.push_back(p_world);
  }
  size_t possible = in_image.size();  // seen, or not yet asked for
  for (const Vector3d& p_world : in_image) {
    if (static_cast<double>(possible) < enough * all) break;
    if (hidden(T_world_left.translation(), p_world)) --possible;
  }
  return static_cast<double>(possible) / all;
}

bool Sight::hidden(const Vector3d& eye_world, const Vector3d& p_world) const {
  const Vector3d ray = p_world - eye_world;
  const double free_m = ray.norm() - kHiding_m;
  return free_m > 0 && scene_.cast(eye_world, ray, free_m).has_value();
}

}  // namespace groundloop::bench
