#include "slam/tracking/tracker.h"

#include <cmath>

#include "slam/stereo/right_lag.h"
#include "slam/tracking/perspective.h"

namespace groundloop::slam {
namespace {

constexpr double kMinDepth_m = 0.05;
constexpr float kNear_px = 1;

Eigen::Vector2f left_of(const Eigen::Vector3d& uvu) { return uvu.head<2>().cast<float>(); }
Eigen::Vector2f right_of(const Eigen::Vector3d& uvu) {
  return Eigen::Vector2d(uvu.z(), uvu.y()).cast<float>();
}

/// How a small window that faces the camera changes: it grows as it comes nearer and turns as the camera
/// rolls.
Eigen::Matrix2f shape_change(const Pose& T_left_previous, double growth) {
  const double roll = std::atan2(T_left_previous.linear()(1, 0), T_left_previous.linear()(0, 0));
  const double c = growth * std::cos(roll), s = growth * std::sin(roll);
  return (Eigen::Matrix2d() << c, -s, s, c).finished().cast<float>();
}

}  // namespace

Tracker::Tracker(const StereoRig& rig, const TrackingOptions& options, const KltOptions& klt,
                 const StereoMatcher& matcher)
    : rig_(rig), options_(options), klt_(klt), matcher_(matcher) {}

void Tracker::track(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_previous,
                    const Pose& T_kf_left, bool planned, const RightLag& lag) {
  const int start_level = planned ? options_.planned_start_level : options_.start_level;
  const Pose T_previous_kf = T_kf_previous.inverse(), T_left_kf = T_kf_left.inverse();
  for (Feature& feature : features_) {
    const Eigen::Vector3d p_previous = T_previous_kf * feature.p_kf;
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    if (p_previous.z() < kMinDepth_m || p_left.z() < kMinDepth_m) {
      feature.in_left = feature.found_right = feature.in_right = false;
      continue;
    }
    const Eigen::Vector3d now = rig_.project(p_left), before = rig_.project(p_previous);
    feature.shape_before = feature.left.A;
    // From where it was found last, moved by the predicted displacement; a feature that was not found then
    // starts from its point alone.
    AffineState start_left = feature.left, start_right = feature.right;
    start_left.uv_px = left_of(now);
    if (feature.in_left) start_left.uv_px += feature.left.uv_px - left_of(before);
    feature.late_px = lag.shift_px(rig_, p_left);
    start_right.uv_px = right_of(now) + feature.late_px;
    if (feature.in_right) start_right.uv_px += feature.right.uv_px - right_of(before);
    const Eigen::Matrix2f change = shape_change(T_left_kf * T_kf_previous, p_previous.z() / p_left.z());
    start_left.A = change * feature.left.A;
    start_right.A = change * feature.right.A;
    start_left.c_per_px = start_right.c_per_px = perspective_of(feature, T_left_kf, p_left);
    track_one(left, right, start_left, start_right, start_level, feature);
  }
}

void Tracker::track_again(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_previous,
                          const Pose& T_kf_left, const RightLag& lag) {
  const Pose T_previous_kf = T_kf_previous.inverse(), T_left_kf = T_kf_left.inverse();
  for (Feature& feature : features_) {
    if (feature.in_left && feature.in_right && feature.is_inlier) continue;
    const Eigen::Vector3d p_previous = T_previous_kf * feature.p_kf;
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    if (p_previous.z() < kMinDepth_m || p_left.z() < kMinDepth_m) continue;
    const Eigen::Vector3d now = rig_.project(p_left);
    AffineState start;
    start.A = shape_change(T_left_kf * T_kf_previous, p_previous.z() / p_left.z()) * feature.shape_before;
    start.uv_px = left_of(now);
    start.c_per_px = perspective_of(feature, T_left_kf, p_left);
    AffineState start_right = start;
    feature.late_px = lag.shift_px(rig_, p_left);
    start_right.uv_px = right_of(now) + feature.late_px;
    track_one(left, right, start, start_right, options_.start_level, feature);
  }
}

Eigen::Vector2f Tracker::perspective_of(const Feature& feature, const Pose& T_left_kf,
                                        const Eigen::Vector3d& p_left) const {
  if (!options_.perspective) return Eigen::Vector2f::Zero();
  return perspective_per_px(rig_, T_left_kf * feature.T_kf_first, p_left, feature.slope_per_px);
}

void Tracker::track_one(const ImagePyramid& left, const ImagePyramid& right, const AffineState& start_left,
                        const AffineState& start_right, int start_level, Feature& feature) const {
  const PatchTemplate& patch = first_view(feature);
  feature.found_right = feature.in_right = false;
  feature.in_left = find(patch, left, start_left, start_level, feature.left);
  if (!feature.in_left) return;
  feature.found_right = find(patch, right, start_right, start_level, feature.right);
  feature.right.uv_px -= feature.late_px;
  feature.in_right = feature.found_right && matcher_.plausible(feature.left.uv_px, feature.right.uv_px);
}

void Tracker::take_off(const RightLag& lag, const Pose& T_kf_left) {
  const Pose T_left_kf = T_kf_left.inverse();
  for (Feature& feature : features_) {
    if (!feature.found_right) continue;
    feature.right.uv_px += feature.late_px;
    feature.late_px = lag.shift_px(rig_, T_left_kf * feature.p_kf);
    feature.right.uv_px -= feature.late_px;
    feature.in_right = matcher_.plausible(feature.left.uv_px, feature.right.uv_px);
  }
}

bool Tracker::find(const PatchTemplate& patch, const ImagePyramid& image, const AffineState& start,
                   int start_level, AffineState& state) const {
  const auto found_from = [&](int level) {
    state = start;
    return track_affine(patch, image, klt_, level, state) == KltStatus::kTracked;
  };
  // The finest level alone is for what is where it was expected: from farther away it may stop before it is
  // there.
  const bool found = found_from(start_level);
  const bool near = start_level > 0 || (state.uv_px - start.uv_px).norm() < kNear_px;
  if (found && near) return true;
  if (start_level < options_.start_level && found_from(options_.start_level)) return true;
  if (std::max(start_level, options_.start_level) + 1 < patch.levels && found_from(patch.levels - 1))
    return true;
  state = start;
  return false;
}

Feature* Tracker::add(const ImagePyramid& left, const Eigen::Vector2f& uv_px) {
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<int>(templates_.size()));
    templates_.push_back(std::make_unique<PatchTemplate>());
  }
  const int slot = free_slots_.back();
  if (!templates_[slot]->take(left, uv_px, klt_.levels)) return nullptr;
  if (options_.perspective) templates_[slot]->learn_pull();
  free_slots_.pop_back();
  Feature feature;
  feature.id = next_id_++;
  feature.slot = slot;
  feature.first_uv_px = feature.left.uv_px = uv_px;
  feature.left.ncc = 1;
  feature.in_left = true;
  features_.push_back(feature);
  return &features_.back();
}

void Tracker::clear() {
  for (const Feature& feature : features_) free_slots_.push_back(feature.slot);
  features_.clear();
}

}  // namespace groundloop::slam
