#include "slam/stereo/right_lag.h"

namespace groundloop::slam {
namespace {

constexpr double kFar_m = 1e6;  // only turning moves what is so far away
constexpr double kNearest_m = 0.05;
constexpr int kRounds = 4;  // each leaves a part of the error as small as advance / depth

}  // namespace

double RightLag::row_flow_px_per_s(const StereoRig& rig, const Eigen::Vector3d& p_left) const {
  const Eigen::Vector3d p = T_late_left_ * p_left;
  if (p.z() < kNearest_m) return 0;
  const Eigen::Vector3d p_per_s = -velocity_.head<3>() - velocity_.tail<3>().cross(p);
  return rig.fy_px * (p_per_s.y() - p_per_s.z() * p.y() / p.z()) / p.z();
}

Eigen::Vector2f RightLag::shift_px(const StereoRig& rig, const Eigen::Vector3d& p_left) const {
  if (none()) return Eigen::Vector2f::Zero();
  const Eigen::Vector3d p_late = T_late_left_ * p_left;
  if (p_left.z() < kNearest_m || p_late.z() < kNearest_m) return Eigen::Vector2f::Zero();
  const Eigen::Vector3d shift = rig.project(p_late) - rig.project(p_left);
  return Eigen::Vector2d(shift.z(), shift.y()).cast<float>();
}

Eigen::Vector2f RightLag::shift_px(const StereoRig& rig, const Eigen::Vector2f& left_px,
                                   const Eigen::Vector2f& right_px) const {
  if (none()) return Eigen::Vector2f::Zero();
  const Eigen::Vector3d ray((left_px.x() - rig.cx_px) / rig.fx_px, (left_px.y() - rig.cy_px) / rig.fy_px, 1);
  Eigen::Vector2f shift = shift_px(rig, kFar_m * ray);
  for (int round = 0; round < kRounds; ++round) {
    const double u_right_px = right_px.x() - shift.x();
    const std::optional<Eigen::Vector3d> p_left = rig.triangulate({left_px.x(), left_px.y(), u_right_px});
    if (!p_left) return shift;
    shift = shift_px(rig, *p_left);
  }
  return shift;
}

}  // namespace groundloop::slam
