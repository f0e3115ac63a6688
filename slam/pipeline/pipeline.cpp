#include "slam/pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "slam/features/detector.h"
#include "slam/pipeline/stage_clock.h"
#include "slam/pipeline/state_hash.h"
#include "slam/registration/registration.h"
#include "slam/stereo/disparity.h"
#include "slam/stereo/matcher.h"
#include "slam/tracking/rotation_alignment.h"
#include "slam/tracking/tracker.h"
#include "slam/types/counter_random.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {
namespace {

constexpr int kBorder_px = 18;  // keeps a first view with its gradients inside the image

}  // namespace

struct Pipeline::Impl {
  Impl(const StereoRig& stereo_rig, const SlamOptions& slam_options)
      : rig(stereo_rig),
        options(slam_options),
        detector(options.detection),
        dense(options.disparity),
        matcher(rig, options.stereo, options.klt),
        tracker(rig, options.tracking, options.klt, matcher),
        rotation(rig),
        registration(rig, options.registration),
        mapper(rig, options.mapping) {}

  void process(const StereoFrame& frame, FrameResult& result);
  void track_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void register_frame(uint64_t seed, const Pose& T_kf_predicted);
  void lose(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void start_segment(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void make_key_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void reconstruct();
  void add_features(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void measure_key_frame(int64_t frame_index);
  bool wants_key_frame(const FrameResult& result) const;
  void update_map(const StereoFrame& frame, const Matrix6d& covariance);
  void update_cloud(const StereoFrame& frame);
  void note(const Feature& feature, bool is_new, FrameResult& result) const;
  void record(const StereoFrame& frame, FrameResult& result);
  Pose predicted_T_kf_left(const StereoFrame& frame) const;
  void check(const StereoFrame& frame) const;

  const StereoRig rig;
  const SlamOptions options;
  Detector detector;
  DenseDisparity dense;
  StereoMatcher matcher;
  Tracker tracker;
  RotationAlignment rotation;
  Registration registration;
  Mapper mapper;

  ImagePyramid left, right;
  std::vector<PointPair> pairs;
  std::vector<size_t> pair_feature;  ///< index into tracker.features(), per pair
  RegistrationResult registered;
  std::vector<Eigen::Vector2f> occupied;
  std::vector<double> depths_m;
  std::vector<Eigen::Vector3f> dense_points;

  bool started = false;
  int segment = 0;
  int frames_lost = 0;
  Pose T_map_kf = Pose::Identity();
  Pose T_kf_left = Pose::Identity();        ///< last frame in the last key frame
  Pose T_previous_left = Pose::Identity();  ///< last motion, for constant velocity
  int64_t kf_frame = 0;
  size_t kf_features = 0;        ///< reconstructed at the last key frame
  double kf_median_depth_m = 0;  ///< of those features
  std::vector<KeyFrameRecord> key_frames;
  std::vector<CloudPoint> cloud;  ///< p_map is kept in the left camera of its key frame
  std::vector<LoopLink> links;
  Trajectory trajectory;
};

Pipeline::Pipeline(const StereoRig& rig, const SlamOptions& options)
    : impl_(std::make_unique<Impl>(rig, options)) {}
Pipeline::~Pipeline() = default;

FrameResult Pipeline::process(const StereoFrame& frame) {
  FrameResult result;
  impl_->process(frame, result);
  return result;
}

void Pipeline::finish() {}
const Trajectory& Pipeline::trajectory() const { return impl_->trajectory; }
const std::vector<KeyFrameRecord>& Pipeline::key_frames() const { return impl_->key_frames; }
OccupancyMap Pipeline::map() const { return impl_->mapper.grid().map(); }
std::vector<OccupancyMap> Pipeline::layers() const { return impl_->mapper.grid().layers(); }
const cv::Mat& Pipeline::last_disparity() const { return impl_->dense.half_resolution(); }
const SlamOptions& Pipeline::options() const { return impl_->options; }

const std::vector<LoopLink>& Pipeline::links() const { return impl_->links; }

std::vector<CloudPoint> Pipeline::cloud() const {
  std::vector<CloudPoint> cloud = impl_->cloud;
  for (CloudPoint& point : cloud) point.p_map = impl_->key_frames[point.key_frame].T_map_left * point.p_map;
  return cloud;
}

/// One stereo pair, in the order of the paper's section 2.
void Pipeline::Impl::process(const StereoFrame& frame, FrameResult& result) {
  check(frame);
  result.index = frame.index;
  result.stamp_ns = frame.stamp_ns;
  StageClock clock(result);

  left.build(frame.left, options.klt.levels);
  right.build(frame.right, options.klt.levels);
  clock.lap(Stage::kPyramid);

  if (!started) {
    // While there is nothing to see, the plan goes on.
    if (!trajectory.empty()) T_kf_left = predicted_T_kf_left(frame);
    start_segment(frame, clock, result);
  } else {
    track_frame(frame, clock, result);
    if (result.status == TrackingStatus::kLost) {
      lose(frame, clock, result);
    } else if (wants_key_frame(result)) {
      make_key_frame(frame, clock, result);
    }
  }
  record(frame, result);
}

/// Tracks the features of the last key frame and registers their new reconstruction with the old one.
void Pipeline::Impl::track_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  const auto seed = static_cast<uint64_t>(frame.index);
  const auto few = [this](double share) {
    return registered.inliers < static_cast<int>(share * static_cast<double>(kf_features));
  };
  Pose T_kf_predicted = predicted_T_kf_left(frame);
  tracker.track(left, right, T_kf_left, T_kf_predicted);
  clock.lap(Stage::kTracking);
  register_frame(seed, T_kf_predicted);
  clock.lap(Stage::kRegistration);

  // The plan was far off, or there is none: let the whole image say how the camera turned.
  if (!registered.usable || few(0.4)) {
    Pose T_left = T_kf_left.inverse() * T_kf_predicted;
    T_left.linear() = rotation.align(left, T_left.linear());
    T_kf_predicted = T_kf_left * T_left;
    tracker.track_again(left, right, T_kf_left, T_kf_predicted);
    clock.lap(Stage::kTracking);
    register_frame(seed, T_kf_predicted);
    clock.lap(Stage::kRegistration);
  }
  // Features that were looked for in the wrong place are looked for again where the motion found puts them.
  if (registered.usable && few(0.7)) {
    tracker.track_again(left, right, T_kf_left, registered.T_from_to);
    clock.lap(Stage::kTracking);
    register_frame(seed, registered.T_from_to);
    clock.lap(Stage::kRegistration);
  }
  rotation.remember(left);

  for (const Feature& feature : tracker.features()) {
    if (feature.in_left) note(feature, false, result);
  }
  result.features_tracked = static_cast<int>(pairs.size());
  result.inliers = registered.inliers;
  result.residual_px = registered.residual_px;
  result.covariance = registered.covariance;
  if (registered.usable) {
    result.status = TrackingStatus::kTracking;
    T_previous_left = T_kf_left.inverse() * registered.T_from_to;
    T_kf_left = registered.T_from_to;
    frames_lost = 0;
  } else {
    result.status = TrackingStatus::kLost;
    result.message = registered.message;
    T_kf_left = T_kf_predicted;
  }
}

void Pipeline::Impl::register_frame(uint64_t seed, const Pose& T_kf_predicted) {
  pairs.clear();
  pair_feature.clear();
  std::vector<Feature>& features = tracker.features();
  for (size_t i = 0; i < features.size(); ++i) {
    features[i].is_inlier = false;
    if (!features[i].in_right) continue;
    pairs.push_back({features[i].p_kf, features[i].covariance_kf,
                     optimal_measurement(features[i].left.uv_px, features[i].right.uv_px)});
    pair_feature.push_back(i);
  }
  registration.align(pairs, T_kf_predicted, mix_bits(options.seed) ^ seed, registered);
  for (size_t k = 0; k < pairs.size(); ++k) features[pair_feature[k]].is_inlier = registered.inlier[k] != 0;
}

/// Without a pose the plan is believed for some frames; then everything starts anew where the plan says.
void Pipeline::Impl::lose(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  if (++frames_lost <= options.tracking.hold_lost_frames) return;
  const std::string why = result.message;
  start_segment(frame, clock, result);
  result.status = TrackingStatus::kLost;
  result.message = why;
}

void Pipeline::Impl::start_segment(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  const bool first = trajectory.empty();
  T_map_kf = first ? rig.T_body_left : T_map_kf * T_kf_left;
  T_kf_left.setIdentity();
  tracker.clear();
  add_features(frame, clock, result);
  rotation.remember(left);
  measure_key_frame(frame.index);
  if (static_cast<int>(kf_features) < options.registration.min_inliers) {
    tracker.clear();
    started = false;
    result.status = TrackingStatus::kLost;
    result.message = fmt::format("{} features found in both images, {} needed to start", kf_features,
                                 options.registration.min_inliers);
    return;
  }
  if (!first) ++segment;
  started = true;
  frames_lost = 0;
  result.status = TrackingStatus::kStarted;
  result.is_key_frame = true;
  update_map(frame, result.covariance);
  clock.lap(Stage::kMapping);
}

/// The reconstruction of this frame takes the place of the last key frame's, and new features join.
void Pipeline::Impl::make_key_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  T_map_kf = renormalised(T_map_kf * T_kf_left);
  T_kf_left.setIdentity();
  tracker.remove_if([](const Feature& f) { return !f.in_right || !f.is_inlier; });
  reconstruct();
  add_features(frame, clock, result);
  measure_key_frame(frame.index);
  result.is_key_frame = true;
  update_map(frame, result.covariance);
  clock.lap(Stage::kMapping);
}

/// Triangulates the tracked features where they are now.
void Pipeline::Impl::reconstruct() {
  tracker.remove_if([this](Feature& feature) {
    const Eigen::Vector3d uvu = optimal_measurement(feature.left.uv_px, feature.right.uv_px);
    const std::optional<Eigen::Vector3d> p = rig.triangulate(uvu);
    if (!p) return true;
    feature.p_kf = *p;
    feature.covariance_kf = point_covariance(rig, uvu, options.registration.sigma_px);
    ++feature.key_frames;
    return false;
  });
}

/// New features, their match in the right image and their first reconstruction. Sections 2.1 and 2.2.
void Pipeline::Impl::add_features(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  occupied.clear();
  for (const Feature& feature : tracker.features()) occupied.push_back(feature.left.uv_px);
  const int wanted = options.tracking.max_features - static_cast<int>(occupied.size());
  const std::vector<Eigen::Vector2f>& corners = detector.detect(frame.left, occupied, wanted, kBorder_px);
  clock.lap(Stage::kDetection);
  dense.compute(frame.left, frame.right);
  clock.lap(Stage::kDisparity);
  for (const Eigen::Vector2f& corner : corners) {
    Feature* feature = tracker.add(left, corner);
    if (feature == nullptr) continue;
    const auto match = matcher.match(tracker.first_view(*feature), feature->left, dense, right);
    if (!match) continue;
    feature->right = *match;
    feature->in_right = true;
    const Eigen::Vector3d uvu = optimal_measurement(feature->left.uv_px, feature->right.uv_px);
    feature->p_kf = *rig.triangulate(uvu);
    feature->covariance_kf = point_covariance(rig, uvu, options.registration.sigma_px);
    feature->key_frames = 1;
  }
  tracker.remove_if([](const Feature& f) { return !f.in_right; });
  for (const Feature& feature : tracker.features()) {
    if (feature.key_frames == 1) note(feature, true, result);
  }
  clock.lap(Stage::kStereo);
}

void Pipeline::Impl::measure_key_frame(int64_t frame_index) {
  kf_frame = frame_index;
  kf_features = tracker.features().size();
  depths_m.clear();
  for (const Feature& feature : tracker.features()) depths_m.push_back(feature.p_kf.z());
  if (depths_m.empty()) return;
  const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
  std::nth_element(depths_m.begin(), middle, depths_m.end());
  kf_median_depth_m = *middle;
}

bool Pipeline::Impl::wants_key_frame(const FrameResult& result) const {
  const KeyFrameOptions& when = options.key_frame;
  return T_kf_left.translation().norm() > when.max_translation_ratio * kf_median_depth_m ||
         rotation_angle_rad(T_kf_left.linear()) > when.max_rotation_deg * std::numbers::pi / 180 ||
         result.inliers < when.min_tracked_ratio * static_cast<double>(kf_features) ||
         result.index - kf_frame >= when.max_interval_frames;
}

Pose Pipeline::Impl::predicted_T_kf_left(const StereoFrame& frame) const {
  return T_kf_left * frame.T_previous_left.value_or(T_previous_left);
}

void Pipeline::Impl::note(const Feature& feature, bool is_new, FrameResult& result) const {
  result.features.push_back({feature.id, feature.left.uv_px.x(), feature.left.uv_px.y(),
                             feature.right.uv_px.x(), feature.right.uv_px.y(), feature.in_right, is_new,
                             feature.is_inlier});
}

void Pipeline::Impl::record(const StereoFrame& frame, FrameResult& result) {
  result.segment = segment;
  result.T_map_left = T_map_kf * T_kf_left;
  result.state_hash = state_hash(result);
  trajectory.push_back({frame.stamp_ns, result.T_map_left});
}

/// The points of a key frame enter the map and the cloud. Section 2.4.
void Pipeline::Impl::update_map(const StereoFrame& frame, const Matrix6d& covariance) {
  constexpr double kTrustedAfter = 3;  // key frames; a point seen once is trusted a third
  KeyFrameRecord record{frame.index, frame.stamp_ns, segment, T_map_kf, covariance, {}};
  record.observations.reserve(tracker.features().size());
  for (const Feature& feature : tracker.features()) {
    const Eigen::Vector3d uvu = optimal_measurement(feature.left.uv_px, feature.right.uv_px);
    const double trust = std::min(1.0, feature.key_frames / kTrustedAfter);
    record.observations.push_back({uvu.cast<float>(), static_cast<float>(trust)});
  }
  if (options.dense_map.step_px > 0) {
    dense_points.clear();
    dense.sample(options.dense_map.step_px, dense_points);
    for (const Eigen::Vector3f& uvu : dense_points) {
      record.observations.push_back({uvu, static_cast<float>(options.dense_map.weight)});
    }
  }
  mapper.add(T_map_kf, record.observations);
  key_frames.push_back(std::move(record));
  update_cloud(frame);
}

/// A feature enters the cloud once two key frames agree on it, and stays as the key frame nearest to it saw
/// it.
void Pipeline::Impl::update_cloud(const StereoFrame& frame) {
  const int key_frame = static_cast<int>(key_frames.size()) - 1;
  for (Feature& feature : tracker.features()) {
    if (feature.key_frames < 2) continue;
    const auto sigma_m = static_cast<float>(std::sqrt(feature.covariance_kf(2, 2)));
    const auto grey =
        frame.left.at<uint8_t>(cvRound(feature.left.uv_px.y()), cvRound(feature.left.uv_px.x()));
    if (feature.cloud_point < 0) {
      feature.cloud_point = static_cast<int>(cloud.size());
      cloud.push_back({feature.p_kf, sigma_m, grey, key_frame});
    } else if (sigma_m < cloud[feature.cloud_point].sigma_m) {
      cloud[feature.cloud_point] = {feature.p_kf, sigma_m, grey, key_frame};
    }
  }
}

void Pipeline::Impl::check(const StereoFrame& frame) const {
  const cv::Size size(rig.width_px, rig.height_px);
  if (frame.left.type() != CV_8UC1 || frame.right.type() != CV_8UC1 || frame.left.size() != size ||
      frame.right.size() != size) {
    throw std::invalid_argument(fmt::format("frame {}: wanted two 8-bit grey images of {} x {} px",
                                            frame.index, rig.width_px, rig.height_px));
  }
}

}  // namespace groundloop::slam
