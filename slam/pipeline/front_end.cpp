#include "slam/pipeline/front_end.h"

#include <fmt/format.h>

#include <algorithm>

#include "slam/stereo/on_time_view.h"
#include "slam/tracking/perspective.h"
#include "slam/types/counter_random.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {
namespace {

constexpr int kBorder_px = 18;  // keeps a first view with its gradients inside the image

}  // namespace

FrontEnd::FrontEnd(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle)
    : rig_(rig),
      options_(options),
      oracle_(oracle),
      detector_(options.detection),
      dense_(options.disparity),
      matcher_(rig, options.stereo, options.klt),
      rows_(options.stereo),
      lag_estimate_(options.stereo),
      tracker_(rig, options.tracking, options.klt, matcher_),
      rotation_(rig),
      registration_(rig, options.registration) {}

StereoFrame FrontEnd::rows_aligned(const StereoFrame& frame) {
  StereoFrame aligned = frame;
  aligned.right = rows_.aligned(frame.right);
  return aligned;
}

void FrontEnd::see(const StereoFrame& frame, StageClock& clock) {
  row_differences_px_.clear();
  elapsed_s_ = static_cast<double>(frame.stamp_ns - seen_ns_) * 1e-9;
  seen_ns_ = frame.stamp_ns;
  lag_ = {};
  left_.build(frame.left, options_.klt.levels);
  right_.build(frame.right, options_.klt.levels);
  clock.lap(Stage::kPyramid);
}

const RegistrationResult& FrontEnd::follow(const StereoFrame& frame, const Pose& T_kf_previous,
                                           Pose& T_kf_predicted, StageClock& clock) {
  const auto few = [this](double share) {
    return registered_.inliers < static_cast<int>(share * static_cast<double>(kf_features_));
  };
  const auto align = [&](const Pose& T_kf_start) {
    clock.lap(Stage::kTracking);
    register_points(frame, T_kf_start);
    clock.lap(Stage::kRegistration);
  };
  if (replaced(OracleStage::kTracking)) {
    look_up_tracks(frame.index);
    align(T_kf_predicted);
    return registered_;
  }
  const int expected = expected_in_view(T_kf_predicted);
  lag_ = lag_after(T_kf_previous.inverse() * T_kf_predicted);
  tracker_.track(left_, right_, T_kf_previous, T_kf_predicted, frame.T_previous_left.has_value(), lag_);
  check_lag(T_kf_previous, T_kf_predicted);
  align(T_kf_predicted);

  // The plan was far off, or there is none: let the whole image say how the camera turned.
  if (!registered_.usable || few(0.4)) {
    Pose T_left = T_kf_previous.inverse() * T_kf_predicted;
    T_left.linear() = rotation_.align(left_, T_left.linear());
    T_kf_predicted = T_kf_previous * T_left;
    lag_ = lag_after(T_left);
    tracker_.track_again(left_, right_, T_kf_previous, T_kf_predicted, lag_);
    align(T_kf_predicted);
  }
  // Features that were looked for in the wrong place are looked for again where the motion found puts them.
  if (registered_.usable && few(0.7)) {
    tracker_.track_again(left_, right_, T_kf_previous, registered_.T_from_to, lag_);
    align(registered_.T_from_to);
  }
  rotation_.remember(left_);
  for (const Feature& feature : tracker_.features()) note_row(feature);
  elapsed_before_s_ = registered_.usable ? elapsed_s_ : 0;
  if (elapsed_before_s_ > 0)
    velocity_before_ = se3_log(T_kf_previous.inverse() * registered_.T_from_to) / elapsed_s_;
  distrust_few(expected);
  return registered_;
}

/// The lag as known, at the speed of this frame.
RightLag FrontEnd::lag_after(const Pose& T_previous_left) const {
  if (!(elapsed_s_ > 0)) return {};
  Vector6d velocity = se3_log(T_previous_left) / elapsed_s_;
  const double late_s = lag_estimate_.late_s();
  // Means over the last two times between frames, carried on to the time between the exposures.
  if (elapsed_before_s_ > 0)
    velocity += (velocity - velocity_before_) * ((elapsed_s_ + late_s) / (elapsed_s_ + elapsed_before_s_));
  return {velocity, late_s};
}

/// Learns from the rows of what was tracked how late the right image is, and takes it off.
void FrontEnd::check_lag(const Pose& T_kf_previous, const Pose& T_kf_left) {
  if (!lag_estimate_.wanted()) return;
  const Pose T_left_kf = T_kf_left.inverse();
  lag_sights_.clear();
  for (const Feature& feature : tracker_.features()) {
    if (!feature.found_right) continue;
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    const double off_px = feature.right.uv_px.y() - feature.left.uv_px.y();
    lag_sights_.push_back({p_left.head<2>() / p_left.z(), off_px, lag_.row_flow_px_per_s(rig_, p_left)});
  }
  const double before_s = lag_estimate_.late_s();
  lag_estimate_.observe(lag_sights_);
  if (lag_estimate_.late_s() == before_s) return;
  lag_ = lag_after(T_kf_previous.inverse() * T_kf_left);
  tracker_.take_off(lag_, T_kf_left);
}

/// Whether the left image has no more grey values to tell at a place: whatever is there cannot be seen.
bool FrontEnd::blown_out(const Eigen::Vector2d& uv_px) const {
  constexpr int kWhite = 250 * ImagePyramid::kScale;  // a little less than full: noise goes downwards only
  return left_.level(0).at<int16_t>(cvRound(uv_px.y()), cvRound(uv_px.x())) >= kWhite;
}

/// Features of the last key frame that the plan puts into both images, where they can be seen.
int FrontEnd::expected_in_view(const Pose& T_kf_predicted) const {
  const Pose T_left_kf = T_kf_predicted.inverse();
  int expected = 0;
  for (const Feature& feature : tracker_.features()) {
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    if (p_left.z() <= 0) continue;
    const Eigen::Vector3d uvu = rig_.project(p_left);
    const bool inside = uvu.z() >= kBorder_px && uvu.x() < rig_.width_px - kBorder_px &&
                        uvu.y() >= kBorder_px && uvu.y() < rig_.height_px - kBorder_px;
    if (inside && !blown_out(uvu.head<2>())) ++expected;
  }
  return expected;
}

/// Walls and floors repeat themselves: where most features have gone at once, those that seem to be left may
/// be others that look the same.
void FrontEnd::distrust_few(int expected) {
  if (!registered_.usable || registered_.inliers >= options_.tracking.min_kept_ratio * expected) return;
  registered_.usable = false;
  registered_.message = fmt::format("{} of {} features that should be in view agree on one motion",
                                    registered_.inliers, expected);
}

void FrontEnd::register_points(const StereoFrame& frame, const Pose& T_kf_predicted) {
  pairs_.clear();
  pair_feature_.clear();
  std::vector<Feature>& features = tracker_.features();
  for (size_t i = 0; i < features.size(); ++i) {
    features[i].is_inlier = false;
    if (!features[i].in_right) continue;
    weigh(features[i]);
    pairs_.push_back({features[i].p_kf, features[i].covariance_kf,
                      optimal_measurement(features[i].left.uv_px, features[i].right.uv_px),
                      features[i].cofactor});
    pair_feature_.push_back(i);
  }
  const uint64_t seed = mix_bits(options_.seed) ^ static_cast<uint64_t>(frame.index);
  registration_.align(pairs_, T_kf_predicted, seed, registered_);
  for (size_t k = 0; k < pairs_.size(); ++k)
    features[pair_feature_[k]].is_inlier = registered_.inlier[k] != 0;
  if (!replaced(OracleStage::kMotion)) return;
  const std::optional<Pose> exact = oracle_->T_from_to(kf_frame_, frame.index);
  registered_.usable = registered_.usable && exact;
  if (exact) registered_.T_from_to = *exact;
}

void FrontEnd::weigh(Feature& feature) const {
  if (options_.tracking.own_precision)
    feature.cofactor = match_cofactor(feature.left.covariance_px2, feature.right.covariance_px2);
}

void FrontEnd::look_up_tracks(int64_t frame) {
  for (Feature& feature : tracker_.features()) {
    const auto match = oracle_->track(feature.first_frame, feature.first_uv_px.cast<double>(), frame);
    feature.in_left = match.has_value();
    feature.in_right = match && match->right_px;
    if (feature.in_left) feature.left.uv_px = match->left_px.cast<float>();
    if (feature.in_right) feature.right.uv_px = match->right_px->cast<float>();
  }
}

void FrontEnd::start(const StereoFrame& frame, StageClock& clock) {
  tracker_.clear();
  elapsed_before_s_ = 0;
  add_features(frame, clock);
  rotation_.remember(left_);
}

void FrontEnd::renew(const StereoFrame& frame, const Pose& T_kf_left, bool reconstruct, StageClock& clock) {
  tracker_.remove_if([](const Feature& f) { return !f.in_right || !f.is_inlier; });
  const Pose T_left_kf = T_kf_left.inverse();
  for (Feature& feature : tracker_.features())
    feature.T_kf_first = renormalised(T_left_kf * feature.T_kf_first);
  if (reconstruct) {
    triangulate_again();
  } else {
    carry_over(T_left_kf);
  }
  add_features(frame, clock);
}

void FrontEnd::triangulate_again() {
  tracker_.remove_if([this](Feature& feature) {
    const Eigen::Vector3d uvu = optimal_measurement(feature.left.uv_px, feature.right.uv_px);
    const std::optional<Eigen::Vector3d> p = rig_.triangulate(uvu);
    if (!p) return true;
    feature.p_kf = *p;
    feature.covariance_kf = point_covariance(rig_, uvu, options_.registration.sigma_px, feature.cofactor);
    ++feature.key_frames;
    return false;
  });
}

void FrontEnd::carry_over(const Pose& T_left_kf) {
  const Eigen::Matrix3d R = T_left_kf.linear();
  for (Feature& feature : tracker_.features()) {
    feature.p_kf = T_left_kf * feature.p_kf;
    feature.covariance_kf = R * feature.covariance_kf * R.transpose();
    ++feature.key_frames;
  }
}

/// New features, their match in the right image and their first reconstruction. Sections 2.1 and 2.2.
void FrontEnd::add_features(const StereoFrame& frame, StageClock& clock) {
  kf_frame_ = frame.index;
  occupied_.clear();
  for (const Feature& feature : tracker_.features()) occupied_.push_back(feature.left.uv_px);
  constexpr double kStandardArea_px = 640 * 480;
  const double share = std::max(1.0, rig_.width_px * rig_.height_px / kStandardArea_px);
  const int wanted = cvRound(share * options_.tracking.max_features) - static_cast<int>(occupied_.size());
  const std::vector<Eigen::Vector2f>& corners = detector_.detect(frame.left, occupied_, wanted, kBorder_px);
  clock.lap(Stage::kDetection);
  look_densely(frame);
  clock.lap(Stage::kDisparity);
  for (const Eigen::Vector2f& corner : corners) {
    Feature* feature = tracker_.add(left_, corner);
    if (feature == nullptr || !match(frame.index, *feature)) continue;
    const Eigen::Vector3d uvu = optimal_measurement(feature->left.uv_px, feature->right.uv_px);
    feature->in_right = true;
    feature->first_frame = frame.index;
    feature->p_kf = *rig_.triangulate(uvu);
    weigh(*feature);
    feature->covariance_kf = point_covariance(rig_, uvu, options_.registration.sigma_px, feature->cofactor);
    feature->slope_per_px = inverse_depth_slope(feature->left, feature->right,
                                                uvu.x() - uvu.z() - rig_.disparity_at_infinity_px());
    feature->key_frames = 1;
  }
  tracker_.remove_if([](const Feature& f) { return !f.in_right; });
  measure_key_frame();
  clock.lap(Stage::kStereo);
}

void FrontEnd::look_densely(const StereoFrame& frame) {
  if (lag_.none()) {
    dense_.compute(frame.left, frame.right);
  } else {
    const OnTimeView view(rig_, lag_, kf_median_depth_m_);
    dense_.compute(frame.left, frame.right, &view);
  }
}

bool FrontEnd::match(int64_t frame, Feature& feature) {
  if (replaced(OracleStage::kStereo)) {
    const std::optional<double> disparity = oracle_->disparity_px(frame, feature.left.uv_px.cast<double>());
    if (!disparity) return false;
    feature.right = feature.left;
    feature.right.uv_px.x() -= static_cast<float>(*disparity);
    return matcher_.plausible(feature.left.uv_px, feature.right.uv_px);
  }
  const auto right = matcher_.match(tracker_.first_view(feature), feature.left, dense_, right_, lag_);
  if (!right) return false;
  feature.right = *right;
  feature.left.covariance_px2 = right->covariance_px2;  // noise of the first view moves all later ones
  feature.found_right = true;
  feature.late_px = lag_.shift_px(rig_, feature.left.uv_px, feature.right.uv_px);
  feature.right.uv_px -= feature.late_px;
  note_row(feature);
  return matcher_.plausible(feature.left.uv_px, feature.right.uv_px);
}

void FrontEnd::note_row(const Feature& feature) {
  if (!feature.found_right) return;
  row_differences_px_.push_back(feature.right.uv_px.y() - feature.left.uv_px.y());
}

void FrontEnd::measure_key_frame() {
  kf_features_ = tracker_.features().size();
  depths_m_.clear();
  for (const Feature& feature : tracker_.features()) depths_m_.push_back(feature.p_kf.z());
  if (depths_m_.empty()) return;
  const auto middle = depths_m_.begin() + static_cast<std::ptrdiff_t>(depths_m_.size() / 2);
  std::nth_element(depths_m_.begin(), middle, depths_m_.end());
  kf_median_depth_m_ = *middle;
}

}  // namespace groundloop::slam
