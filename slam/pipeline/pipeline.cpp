#include "slam/pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "slam/adjustment/window_adjustment.h"
#include "slam/pipeline/back_end.h"
#include "slam/pipeline/background.h"
#include "slam/pipeline/front_end.h"
#include "slam/pipeline/key_frame_window.h"
#include "slam/pipeline/repeated_pair.h"
#include "slam/pipeline/stage_clock.h"
#include "slam/pipeline/state_hash.h"

namespace groundloop::slam {
namespace {

constexpr int64_t kEnd = std::numeric_limits<int64_t>::max();

}  // namespace

struct Pipeline::Impl {
  /// Answer of the background adjustment.
  struct Adjusted {
    WindowProblem window;
    AdjustmentResult result;
    double ms = 0;
  };
  /// A key frame on the path.
  struct Stop {
    Pose T_odom_left;
    int tie = 0;  ///< that its correction follows
  };
  /// A frame on the path.
  struct Step {
    int64_t stamp_ns;
    int key_frame;
    Pose T_kf_left;
  };

  Impl(const StereoRig& stereo_rig, const SlamOptions& slam_options, const Oracle* oracle);

  void process(const StereoFrame& delivered, FrameResult& result);
  void take_results(int64_t frame_index, FrameResult& result);
  void check_rows(FrameResult& result);
  void hold(const StereoFrame& frame, FrameResult& result);
  bool held_too_long(const StereoFrame& frame) const;
  void track_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void lose(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void start_segment(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  void make_key_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result);
  bool wants_key_frame(const FrameResult& result) const;
  void stop_here(const StereoFrame& frame, bool starts_segment, const Matrix6d& covariance,
                 FrameResult& result);
  void give_to_adjustment(const StereoFrame& frame);
  void take_adjustment(const Adjusted& adjusted);
  void give_to_back_end(const StereoFrame& frame, bool starts_segment);
  void take_answer(const BackEndAnswer& answer, FrameResult& result);
  Look look(const StereoFrame& frame, std::vector<MapObservation>& observations);
  std::vector<Landmark> landmarks() const;
  int64_t in_sight_since() const;
  void finish();
  void update_path();
  void hang_held_frames_on(int key_frame, const Pose& T_kf_start);
  void note_features(FrameResult& result) const;
  void record(const StereoFrame& frame, FrameResult& result);
  Pose T_map_odom() const { return T_map_odom_by_tie.back(); }
  Pose predicted_T_kf_left(const StereoFrame& frame) const;
  void check(const StereoFrame& frame) const;

  const StereoRig rig;
  const SlamOptions options;
  const bool adjusts;
  RepeatedPair repeated_pair;
  FrontEnd front;
  KeyFrameWindow window;
  std::vector<OdometryPose> known_better;  ///< refined since the last key frame was handed over

  bool started = false;
  int segment = 0;
  int64_t segment_start = 0;        ///< its first frame
  bool segment_recognised = false;  ///< tied to what was mapped before
  int64_t seen_ns = 0;              ///< time of the last frame with images of its own
  int64_t known_ns = 0;             ///< time of the last frame whose pose was seen
  size_t steps_held = 0;            ///< newest steps that only the plan gave a pose
  int segment_key_frames = 0;
  Pose T_odom_kf = Pose::Identity();
  Pose T_kf_left = Pose::Identity();        ///< last frame in the last key frame
  Pose T_kf_seen = Pose::Identity();        ///< last frame with images of its own in the last key frame
  Pose T_previous_left = Pose::Identity();  ///< last motion, for constant velocity
  std::optional<Pose> T_kf_planned;         ///< planned motion since the last key frame
  int64_t kf_frame = 0;
  std::vector<Stop> stops;  ///< by key frame
  std::vector<Step> steps;  ///< by frame
  std::vector<Pose> T_map_odom_by_tie = {Pose::Identity()};
  int stops_answered = 0;
  std::vector<LoopLink> links;
  std::vector<KeyFrameRecord> key_frames;
  Trajectory trajectory;

  // Last, so that they end before what their jobs use.
  WindowAdjustment adjustment;
  BackEnd back;
  Background<std::shared_ptr<const Adjusted>> adjusting;
  Background<BackEndAnswer> mapping;
};

Pipeline::Pipeline(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle)
    : impl_(std::make_unique<Impl>(rig, options, oracle)) {}
Pipeline::~Pipeline() = default;

FrameResult Pipeline::process(const StereoFrame& frame) {
  FrameResult result;
  impl_->process(frame, result);
  return result;
}

void Pipeline::process(const StereoFrame& frame, FrameResult& result) {
  std::vector<FeatureObservation> features = std::move(result.features);
  features.clear();
  result = {};
  result.features = std::move(features);
  impl_->process(frame, result);
}

void Pipeline::finish() { impl_->finish(); }
const Trajectory& Pipeline::trajectory() const {
  impl_->update_path();
  return impl_->trajectory;
}
const std::vector<KeyFrameRecord>& Pipeline::key_frames() const {
  impl_->update_path();
  return impl_->key_frames;
}
const std::vector<LoopLink>& Pipeline::links() const { return impl_->links; }
OccupancyMap Pipeline::map() const { return impl_->back.map().grid().map(); }
std::vector<OccupancyMap> Pipeline::layers() const { return impl_->back.map().grid().layers(); }
const cv::Mat& Pipeline::last_disparity() const { return impl_->front.dense().half_resolution(); }
const SlamOptions& Pipeline::options() const { return impl_->options; }

std::vector<CloudPoint> Pipeline::cloud() const {
  std::vector<CloudPoint> cloud;
  const std::vector<Pose>& T_map_place = impl_->back.places().T_map_place();
  for (const Look& look : impl_->back.map().looks()) {
    const Pose T_map_left = T_map_place[look.place] * look.T_place_left;
    for (const SeenPoint& point : look.points) {
      cloud.push_back({T_map_left * point.p_left.cast<double>(), point.sigma_m, point.grey, look.key_frame});
    }
  }
  return cloud;
}

Pipeline::Impl::Impl(const StereoRig& stereo_rig, const SlamOptions& slam_options, const Oracle* oracle)
    : rig(stereo_rig),
      options(slam_options),
      adjusts(options.adjustment.key_frames > 1 &&
              (oracle == nullptr || !oracle->replaces(OracleStage::kMotion))),
      front(rig, options, oracle),
      window(options.adjustment),
      adjustment(rig, options.adjustment),
      back(rig, options, oracle),
      adjusting(options.background.threads),
      mapping(options.background.threads) {}

/// One stereo pair, in the order of the paper's section 2.
void Pipeline::Impl::process(const StereoFrame& delivered, FrameResult& result) {
  check(delivered);
  const StereoFrame frame = front.rows_aligned(delivered);
  result.index = frame.index;
  result.stamp_ns = frame.stamp_ns;
  result.row_offset_px = front.row_offset_px();
  result.right_late_s = front.right_late_s();
  StageClock clock(result);
  take_results(frame.index, result);
  clock.restart();
  if (T_kf_planned && frame.T_previous_left) {
    T_kf_planned = *T_kf_planned * *frame.T_previous_left;
  } else {
    T_kf_planned.reset();
  }
  if (repeated_pair.is(delivered) && started && known_ns == seen_ns) {
    hold(frame, result);
    record(frame, result);
    return;
  }
  seen_ns = frame.stamp_ns;
  front.see(frame, clock);
  if (!started) {
    // While there is nothing to see, the plan goes on.
    if (!steps.empty()) T_kf_left = predicted_T_kf_left(frame);
    start_segment(frame, clock, result);
  } else {
    track_frame(frame, clock, result);
    if (result.status == TrackingStatus::kLost) {
      lose(frame, clock, result);
    } else if (wants_key_frame(result)) {
      make_key_frame(frame, clock, result);
    }
  }
  check_rows(result);
  result.right_late_s = front.right_late_s();
  T_kf_seen = T_kf_left;
  record(frame, result);
}

/// What all matches of the pair say of its rows holds from the next pair on.
void Pipeline::Impl::check_rows(FrameResult& result) {
  const std::optional<double> off_px = front.check_rows();
  if (off_px && result.status == TrackingStatus::kLost) {
    result.message = fmt::format("most matches are {:.1f} px beside their rows", *off_px);
  }
}

/// A pair that was seen before tells nothing of the time of its stamp: the plan goes on from the last pose.
void Pipeline::Impl::hold(const StereoFrame& frame, FrameResult& result) {
  T_kf_left = predicted_T_kf_left(frame);
  result.status = held_too_long(frame) ? TrackingStatus::kLost : TrackingStatus::kRepeated;
  result.message = "the images are those of the frame before";
}

/// Whether the plan has been believed for as long as it may be without a pose.
bool Pipeline::Impl::held_too_long(const StereoFrame& frame) const {
  constexpr double kNanosecond_s = 1e-9;
  return static_cast<double>(frame.stamp_ns - known_ns) * kNanosecond_s > options.tracking.hold_lost_s;
}

/// What was done beside the frame path and is due now.
void Pipeline::Impl::take_results(int64_t frame_index, FrameResult& result) {
  adjusting.collect(frame_index, [&](const std::shared_ptr<const Adjusted>& adjusted) {
    result.stage_ms[static_cast<size_t>(Stage::kAdjustment)] += adjusted->ms;
    take_adjustment(*adjusted);
  });
  mapping.collect(frame_index, [&](const BackEndAnswer& answer) { take_answer(answer, result); });
}

void Pipeline::Impl::track_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  Pose T_kf_predicted = predicted_T_kf_left(frame);
  const RegistrationResult& registered = front.follow(frame, T_kf_seen, T_kf_predicted, clock);
  note_features(result);
  result.features_tracked = static_cast<int>(registered.inlier.size());
  result.inliers = registered.inliers;
  result.residual_px = registered.residual_px;
  result.covariance = registered.covariance;
  if (registered.usable) {
    result.status = TrackingStatus::kTracking;
    T_previous_left = T_kf_left.inverse() * registered.T_from_to;
    T_kf_left = registered.T_from_to;
    known_ns = frame.stamp_ns;
  } else {
    result.status = TrackingStatus::kLost;
    result.message = registered.message;
    T_kf_left = T_kf_predicted;
  }
}

/// Without a pose the plan is believed for some time; then everything starts anew where the plan says.
void Pipeline::Impl::lose(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  if (!held_too_long(frame)) return;
  const std::string why = result.message;
  start_segment(frame, clock, result);
  result.status = TrackingStatus::kLost;
  result.message = why;
}

void Pipeline::Impl::start_segment(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  const bool first = steps.empty();
  front.start(frame, clock);
  const auto features = static_cast<int>(front.key_frame_features());
  if (features < options.registration.min_inliers) {
    front.forget_features();
    started = false;
    result.status = TrackingStatus::kLost;
    result.message = fmt::format("{} features found in both images, {} needed to start", features,
                                 options.registration.min_inliers);
    return;
  }
  hang_held_frames_on(static_cast<int>(stops.size()), T_kf_left);
  T_odom_kf = stops.empty() ? rig.T_body_left * T_kf_left : T_odom_kf * T_kf_left;
  T_kf_left.setIdentity();
  if (!first) ++segment;
  segment_recognised = false;
  segment_start = frame.index;
  started = true;
  known_ns = frame.stamp_ns;
  result.status = TrackingStatus::kStarted;
  window.clear();
  stop_here(frame, true, Matrix6d::Zero(), result);
}

/// The reconstruction of this frame takes the place of the last key frame's, and new features join.
void Pipeline::Impl::make_key_frame(const StereoFrame& frame, StageClock& clock, FrameResult& result) {
  front.renew(frame, T_kf_left, !adjusts, clock);
  T_odom_kf = renormalised(T_odom_kf * T_kf_left);
  T_kf_left.setIdentity();
  stop_here(frame, false, result.covariance, result);
}

void Pipeline::Impl::stop_here(const StereoFrame& frame, bool starts_segment, const Matrix6d& covariance,
                               FrameResult& result) {
  result.is_key_frame = true;
  segment_key_frames = starts_segment ? 1 : segment_key_frames + 1;
  note_features(result);
  kf_frame = frame.index;
  const auto number = static_cast<int>(stops.size());
  stops.push_back({T_odom_kf, static_cast<int>(T_map_odom_by_tie.size()) - 1});
  key_frames.push_back(
      {frame.index, frame.stamp_ns, segment, T_map_odom() * T_odom_kf, Pose::Identity(), covariance, {}});
  window.add(number, T_odom_kf, T_kf_planned, front.features());
  T_kf_planned = Pose::Identity();
  if (adjusts) give_to_adjustment(frame);
  give_to_back_end(frame, starts_segment);
}

void Pipeline::Impl::give_to_adjustment(const StereoFrame& frame) {
  if (window.size() < 2) return;
  auto adjusted = std::make_shared<Adjusted>();
  adjusted->window = window.problem({});
  adjusting.submit(frame.index + options.background.adjustment_lag_frames,
                   [this, adjusted]() -> std::shared_ptr<const Adjusted> {
                     const auto start = std::chrono::steady_clock::now();
                     adjustment.solve(adjusted->window.problem, adjusted->result);
                     const std::chrono::duration<double, std::milli> spent =
                         std::chrono::steady_clock::now() - start;
                     adjusted->ms = spent.count();
                     return adjusted;
                   });
}

void Pipeline::Impl::take_adjustment(const Adjusted& adjusted) {
  const AdjustmentResult& result = adjusted.result;
  const std::vector<int>& numbers = adjusted.window.key_frames;
  // A loss of track since then has started a new window.
  if (!result.usable || numbers.back() != static_cast<int>(stops.size()) - 1) return;
  window.refine(numbers, result.T_odom_left);
  for (size_t i = 0; i < numbers.size(); ++i) {
    stops[numbers[i]].T_odom_left = result.T_odom_left[i];
    if (i == 0) continue;
    key_frames[numbers[i]].covariance = result.motion_covariance[i];
    known_better.push_back({numbers[i], result.T_odom_left[i], result.motion_covariance[i]});
  }
  T_odom_kf = result.T_odom_left.back();
  const Pose T_kf_odom = T_odom_kf.inverse();
  const Eigen::Matrix3d R = T_kf_odom.linear();
  const std::vector<int64_t>& ids = adjusted.window.feature_ids;
  for (Feature& feature : front.features()) {
    const auto found = std::lower_bound(ids.begin(), ids.end(), feature.id);
    if (found == ids.end() || *found != feature.id) continue;
    const auto landmark = static_cast<size_t>(found - ids.begin());
    const Eigen::Matrix3d& covariance = result.landmark_covariance[landmark];
    if (covariance.isZero()) continue;
    feature.p_kf = T_kf_odom * result.landmarks_odom[landmark];
    feature.covariance_kf = R * covariance * R.transpose();
  }
}

void Pipeline::Impl::give_to_back_end(const StereoFrame& frame, bool starts_segment) {
  auto handed_over = std::make_shared<HandedOver>();
  handed_over->pose = {static_cast<int>(stops.size()) - 1, T_odom_kf, key_frames.back().covariance};
  handed_over->known_better.swap(known_better);
  handed_over->starts_segment = starts_segment;
  handed_over->T_map_left = T_map_odom() * T_odom_kf;
  handed_over->sight.index = frame.index;
  if (options.loop.enabled || options.dense_map.step_px > 0) {
    handed_over->sight.left = frame.left.clone();
    handed_over->sight.right = frame.right.clone();
    handed_over->sight.right_lag = front.right_lag();
    handed_over->sight.half_disparity = front.dense().half_resolution().clone();
    handed_over->sight.landmarks = landmarks();
    handed_over->sight.in_sight_since = in_sight_since();
  }
  handed_over->look = look(frame, handed_over->observations);
  // Who does not know where it is, waits for nothing else.
  const bool astray = segment > 0 && !segment_recognised;
  mapping.submit(
      frame.index + (astray ? options.background.astray_lag_frames : options.background.map_lag_frames),
      [this, handed_over] { return back.process(std::move(*handed_over)); });
}

/// The features of a key frame for the map and the cloud. Section 2.4.
Look Pipeline::Impl::look(const StereoFrame& frame, std::vector<MapObservation>& observations) {
  constexpr double kTrustedAfter = 3;  // key frames; a point seen once is trusted a third
  Look look;
  observations.reserve(front.features().size());
  for (const Feature& feature : front.features()) {
    const Eigen::Vector3d uvu = optimal_measurement(feature.left.uv_px, feature.right.uv_px);
    const double trust = std::min(1.0, feature.key_frames / kTrustedAfter);
    observations.push_back({uvu.cast<float>(), static_cast<float>(trust)});
    // A feature enters the cloud once two key frames agree on it.
    if (feature.key_frames != 2) continue;
    look.points.push_back(
        {feature.p_kf.cast<float>(), static_cast<float>(std::sqrt(feature.covariance_kf(2, 2))),
         frame.left.at<uint8_t>(cvRound(feature.left.uv_px.y()), cvRound(feature.left.uv_px.x()))});
  }
  return look;
}

/// First frame of the features that have been tracked longest, but for a few: far ones live for very long.
int64_t Pipeline::Impl::in_sight_since() const {
  constexpr size_t kFew = 20;
  std::vector<int64_t> first_frames;
  for (const Feature& feature : front.features()) first_frames.push_back(feature.first_frame);
  if (first_frames.size() <= kFew) return kEnd;
  std::nth_element(first_frames.begin(), first_frames.begin() + kFew, first_frames.end());
  return first_frames[kFew];
}

std::vector<Landmark> Pipeline::Impl::landmarks() const {
  std::vector<Landmark> landmarks;
  landmarks.reserve(front.features().size());
  for (const Feature& feature : front.features()) {
    landmarks.push_back({feature.left.uv_px, static_cast<float>(feature.p_kf.z()),
                         static_cast<float>(std::sqrt(feature.covariance_kf(2, 2)))});
  }
  return landmarks;
}

void Pipeline::Impl::take_answer(const BackEndAnswer& answer, FrameResult& result) {
  result.stage_ms[static_cast<size_t>(Stage::kLoop)] += answer.loop_ms;
  result.stage_ms[static_cast<size_t>(Stage::kMapping)] += answer.mapping_ms;
  T_map_odom_by_tie = answer.T_map_odom;
  for (size_t k = static_cast<size_t>(answer.key_frame); k < stops.size(); ++k) stops[k].tie = answer.tie;
  if (!answer.link) return;
  segment_recognised = segment_recognised || answer.link->to_index >= segment_start;
  links.push_back(*answer.link);
  result.links.push_back(*answer.link);
}

void Pipeline::Impl::finish() {
  FrameResult last;
  take_results(kEnd, last);
  mapping.submit(kEnd, [this] { return back.finish(known_better); });
  take_results(kEnd, last);
  for (const Look& look : back.map().looks()) key_frames[look.key_frame].observations = look.observations;
}

/// Where all corrections known now put the frames and key frames.
void Pipeline::Impl::update_path() {
  for (size_t k = 0; k < stops.size(); ++k) {
    key_frames[k].T_map_left = T_map_odom_by_tie[stops[k].tie] * stops[k].T_odom_left;
    if (k == 0 || key_frames[k].segment != key_frames[k - 1].segment) continue;
    key_frames[k].T_previous_left = stops[k - 1].T_odom_left.inverse() * stops[k].T_odom_left;
  }
  trajectory.clear();
  for (const Step& step : steps) {
    const Pose& T_map_kf = step.key_frame < 0 ? rig.T_body_left : key_frames[step.key_frame].T_map_left;
    trajectory.push_back({step.stamp_ns, T_map_kf * step.T_kf_left});
  }
}

bool Pipeline::Impl::wants_key_frame(const FrameResult& result) const {
  const KeyFrameOptions& when = options.key_frame;
  // A place that nothing predicted is believed when two key frames find it: the second comes soon.
  constexpr int64_t kConfirmAfter = 2;
  const bool confirms = segment > 0 && segment_key_frames == 1 && result.index - kf_frame >= kConfirmAfter;
  return confirms ||
         T_kf_left.translation().norm() > when.max_translation_ratio * front.key_frame_depth_m() ||
         rotation_angle_rad(T_kf_left.linear()) > when.max_rotation_deg * std::numbers::pi / 180 ||
         result.inliers < when.min_tracked_ratio * static_cast<double>(front.key_frame_features()) ||
         result.index - kf_frame >= when.max_interval_frames;
}

Pose Pipeline::Impl::predicted_T_kf_left(const StereoFrame& frame) const {
  return T_kf_left * frame.T_previous_left.value_or(T_previous_left);
}

/// The features of the frame as they are now; a later call replaces an earlier one's.
void Pipeline::Impl::note_features(FrameResult& result) const {
  if (!result.is_key_frame) {
    for (const Feature& feature : front.features()) {
      if (!feature.in_left) continue;
      result.features.push_back({feature.id, feature.left.uv_px.x(), feature.left.uv_px.y(),
                                 feature.right.uv_px.x(), feature.right.uv_px.y(), feature.in_right, false,
                                 feature.is_inlier});
    }
    return;
  }
  for (const Feature& feature : front.features()) {
    if (feature.key_frames != 1) continue;
    result.features.push_back({feature.id, feature.left.uv_px.x(), feature.left.uv_px.y(),
                               feature.right.uv_px.x(), feature.right.uv_px.y(), feature.in_right, true,
                               feature.is_inlier});
  }
}

/// Frames that only the plan gave a pose belong to what follows them: what broke the path, broke it before.
/// @param T_kf_start  new key frame in the old one that the frames hang on
void Pipeline::Impl::hang_held_frames_on(int key_frame, const Pose& T_kf_start) {
  for (size_t i = steps.size() - steps_held; i < steps.size(); ++i) {
    steps[i].T_kf_left = T_kf_start.inverse() * steps[i].T_kf_left;
    steps[i].key_frame = key_frame;
  }
  steps_held = 0;
}

void Pipeline::Impl::record(const StereoFrame& frame, FrameResult& result) {
  result.segment = segment;
  const auto key_frame = static_cast<int>(stops.size()) - 1;
  const Pose T_odom_left = (key_frame < 0 ? rig.T_body_left : T_odom_kf) * T_kf_left;
  result.T_map_left = T_map_odom() * T_odom_left;
  result.state_hash = state_hash(result);
  steps.push_back({frame.stamp_ns, key_frame, T_kf_left});
  const bool held = (result.status == TrackingStatus::kLost && !result.is_key_frame) ||
                    result.status == TrackingStatus::kRepeated;
  steps_held = held ? steps_held + 1 : 0;
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
