#include "bench/metrics/truth/stage_judge.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace groundloop::bench {
namespace {

using Eigen::Vector3d;

/// Surface point [m] in the left camera at a pixel and depth.
Vector3d back_project(const slam::StereoRig& rig, double u_px, double v_px, double depth_m) {
  return {(u_px - rig.cx_px) / rig.fx_px * depth_m, (v_px - rig.cy_px) / rig.fy_px * depth_m, depth_m};
}

/// Difference of measured and true disparity [px].
double disparity_error_px(const slam::StereoRig& rig, const slam::FeatureObservation& feature,
                          double depth_m) {
  const double measured_px =
      static_cast<double>(feature.u_left_px) - feature.u_right_px - rig.disparity_at_infinity_px();
  return measured_px - rig.fx_px * rig.baseline_m / depth_m;
}

}  // namespace

void ErrorSum::add(double error, bool inlier) {
  ++(inlier ? inliers : outliers);
  if (inlier) squared += error * error;
}

ErrorSum& ErrorSum::operator+=(const ErrorSum& other) {
  inliers += other.inliers;
  outliers += other.outliers;
  squared += other.squared;
  return *this;
}

std::optional<double> ErrorSum::rmse() const {
  if (inliers == 0) return std::nullopt;
  return std::sqrt(squared / static_cast<double>(inliers));
}

std::optional<double> ErrorSum::outlier_fraction() const {
  if (inliers + outliers == 0) return std::nullopt;
  return static_cast<double>(outliers) / static_cast<double>(inliers + outliers);
}

StageErrors& StageErrors::operator+=(const StageErrors& other) {
  disparity_px += other.disparity_px;
  track_px += other.track_px;
  point_m += other.point_m;
  registration_trans_m += other.registration_trans_m;
  registration_rot_deg += other.registration_rot_deg;
  return *this;
}

Metrics StageErrors::metrics() const {
  Metrics metrics;
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) metrics[name] = *value;
  };
  add("stage.disparity_rmse_px", disparity_px.rmse());
  add("stage.stereo_outlier_fraction", disparity_px.outlier_fraction());
  add("stage.track_rmse_px", track_px.rmse());
  add("stage.track_outlier_fraction", track_px.outlier_fraction());
  add("stage.point_rmse_m", point_m.rmse());
  add("stage.registration_trans_m", registration_trans_m.rmse());
  add("stage.registration_rot_deg", registration_rot_deg.rmse());
  return metrics;
}

StageJudge::StageJudge(const sim::TruthWorld& truth, const slam::StereoRig& rig) : truth_(truth), rig_(rig) {}

StageErrors StageJudge::judge(const slam::FrameResult& frame, const slam::Pose& T_world_left) {
  StageErrors errors;
  const slam::Pose T_left_world = T_world_left.inverse();
  std::map<int64_t, FirstView> alive;
  for (const slam::FeatureObservation& feature : frame.features) {
    const auto first_view = first_views_.find(feature.id);
    const bool tracked = first_view != first_views_.end();
    if (tracked) {
      alive.insert(*first_view);
      const FirstView& view = first_view->second;
      const Vector3d p_left = T_left_world * *truth_.T_world_geom(view.geom) * view.p_geom;
      if (p_left.z() > 0) {
        const Eigen::Vector2d seen_px(feature.u_left_px, feature.v_left_px);
        const double error_px = (seen_px - rig_.project(p_left).head<2>()).norm();
        errors.track_px.add(error_px, error_px <= kOutlier_px);
      }
    }
    if (tracked && !feature.has_right) continue;
    const auto seen = true_surface(feature, T_world_left);
    if (!seen) continue;
    if (feature.has_right) judge_stereo(feature, seen->depth_m, errors);
    if (!tracked) {
      const Vector3d p_left = back_project(rig_, feature.u_left_px, feature.v_left_px, seen->depth_m);
      const slam::Pose T_geom_world = truth_.T_world_geom(seen->geom)->inverse();
      alive.emplace(feature.id, FirstView{seen->geom, T_geom_world * (T_world_left * p_left)});
    }
  }
  first_views_ = std::move(alive);
  judge_registration(frame, T_world_left, errors);
  total_ += errors;
  return errors;
}

std::optional<StageJudge::Surface> StageJudge::surface(const slam::Pose& T_world_left, double u_px,
                                                       double v_px) const {
  constexpr double kFarthest_m = 100;
  const Vector3d ray_left = back_project(rig_, u_px, v_px, 1);
  const auto hit = truth_.cast(T_world_left.translation(), T_world_left.linear() * ray_left,
                               kFarthest_m * ray_left.norm());
  if (!hit) return std::nullopt;
  return Surface{hit->distance_m / ray_left.norm(), hit->geom};
}

std::optional<StageJudge::Surface> StageJudge::true_surface(const slam::FeatureObservation& feature,
                                                            const slam::Pose& T_world_left) const {
  const double u_px = feature.u_left_px, v_px = feature.v_left_px;
  auto best = surface(T_world_left, u_px, v_px);
  if (!feature.has_right) return best;
  const auto miss_px = [&](const std::optional<Surface>& candidate) {
    return candidate ? std::abs(disparity_error_px(rig_, feature, candidate->depth_m)) : HUGE_VAL;
  };
  if (miss_px(best) <= kOutlier_px) return best;
  constexpr std::array<std::pair<double, double>, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (const auto& [du_px, dv_px] : kNeighbours) {
    const auto neighbour = surface(T_world_left, u_px + du_px, v_px + dv_px);
    if (miss_px(neighbour) < miss_px(best)) best = neighbour;
  }
  return best;
}

void StageJudge::judge_stereo(const slam::FeatureObservation& feature, double true_depth_m,
                              StageErrors& errors) const {
  const double error_px = disparity_error_px(rig_, feature, true_depth_m);
  const bool inlier = std::abs(error_px) <= kOutlier_px;
  errors.disparity_px.add(error_px, inlier);
  const auto p_left = rig_.triangulate({feature.u_left_px, feature.v_left_px, feature.u_right_px});
  if (!inlier || !p_left) return;
  const Vector3d true_left = back_project(rig_, feature.u_left_px, feature.v_left_px, true_depth_m);
  errors.point_m.add((*p_left - true_left).norm(), true);
}

void StageJudge::judge_registration(const slam::FrameResult& frame, const slam::Pose& T_world_left,
                                    StageErrors& errors) {
  if (!frame.is_key_frame) return;
  if (last_key_frame_ && last_key_frame_->segment == frame.segment) {
    const slam::Pose T_estimate = last_key_frame_->T_map_left.inverse() * frame.T_map_left;
    const slam::Pose T_truth = last_key_frame_->T_world_left.inverse() * T_world_left;
    const slam::Pose error = T_truth.inverse() * T_estimate;
    errors.registration_trans_m.add(error.translation().norm(), true);
    errors.registration_rot_deg.add(slam::rotation_angle_rad(error.linear()) * 180 / std::numbers::pi, true);
  }
  last_key_frame_ = KeyFrame{frame.segment, frame.T_map_left, T_world_left};
}

}  // namespace groundloop::bench
