#include "slam/pipeline/back_end.h"

#include <algorithm>
#include <chrono>

namespace groundloop::slam {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

const Oracle* unless_own_work(const Oracle* oracle, OracleStage stage) {
  return oracle != nullptr && oracle->replaces(stage) ? oracle : nullptr;
}

}  // namespace

BackEnd::BackEnd(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle)
    : options_(options),
      exact_loops_(unless_own_work(oracle, OracleStage::kLoops)),
      exact_stereo_(unless_own_work(oracle, OracleStage::kStereo)),
      detector_(rig, options.loop, options.klt, options.stereo, options.registration, options.seed),
      dense_points_(rig, options.dense_map),
      map_(rig, options.mapping, options.key_frame.looks_kept) {
  if (options.map_match.enabled) {
    map_registration_.emplace(rig, options.mapping, options.map_match, options.key_frame.looks_kept);
  }
}

BackEndAnswer BackEnd::process(HandedOver handed_over) {
  const Clock::time_point start = Clock::now();
  frames_.push_back(handed_over.sight.index);
  places_.advance(handed_over.pose, handed_over.known_better);
  if (handed_over.starts_segment) places_.start(handed_over.T_map_left);
  std::optional<LoopLink> link;
  recognise(handed_over, link);
  const double loop_ms = milliseconds_since(start);

  look_densely(handed_over.sight, handed_over.observations);
  handed_over.look.observations =
      std::make_shared<const std::vector<MapObservation>>(std::move(handed_over.observations));
  tie(handed_over.look);
  if (map_registration_) {
    map_registration_->add(handed_over.look, handed_over.sight.index, handed_over.starts_segment);
    if (!link) register_map(link);
    tie(handed_over.look);
  }
  map_.add(std::move(handed_over.look), places_.T_map_place());

  BackEndAnswer result = answer();
  result.link = link;
  result.loop_ms = loop_ms;
  result.mapping_ms = milliseconds_since(start) - loop_ms;
  return result;
}

BackEndAnswer BackEnd::finish(const std::vector<OdometryPose>& known_better) {
  places_.refine(known_better);
  map_.complete(places_.T_map_place(), options_.background.threads);
  return answer();
}

void BackEnd::recognise(const HandedOver& handed_over, std::optional<LoopLink>& link) {
  bool is_place = true;
  if (exact_loops_ != nullptr) {
    link = ask_oracle(handed_over.sight.index);
    is_place = !link;
    if (is_place) stored_places_.push_back(handed_over.pose.key_frame);
  } else if (options_.loop.enabled) {
    LoopAnswer found = detector_.process(
        handed_over.sight, [this](int64_t from, int64_t to) -> std::optional<PosePrediction> {
          const auto motion = places_.relative(key_frame_of(from), key_frame_of(to));
          if (!motion) return std::nullopt;
          return PosePrediction{motion->T_from_to, motion->covariance};
        });
    link = found.link;
    is_place = found.stored;
  }
  if (handed_over.starts_segment) is_place = false;  // it is one already
  if (link) {
    const int place = places_.standing(key_frame_of(link->from_index)).place;
    const Tie seen{place, handed_over.pose.key_frame, link->T_from_to, link->covariance};
    if (!places_.recognise(seen, is_place)) link.reset();
  } else if (is_place) {
    places_.add_place();
  }
}

/// Ties the newest key frame's look to its place.
void BackEnd::tie(Look& look) const {
  const Tie here = places_.standing(static_cast<int>(frames_.size()) - 1);
  look.key_frame = here.key_frame;
  look.place = here.place;
  look.T_place_left = here.T_place_left;
}

/// Adds points of the dense disparity to what a key frame saw.
void BackEnd::look_densely(const LoopKeyFrame& sight, std::vector<MapObservation>& observations) {
  if (options_.dense_map.step_px <= 0) return;
  for (const DensePoint& point :
       dense_points_.measure(sight.left, sight.right, sight.half_disparity, sight.right_lag)) {
    Eigen::Vector3f uvu_px = point.uvu_px;
    if (exact_stereo_ != nullptr) {
      const auto exact_px = exact_stereo_->disparity_px(sight.index, uvu_px.head<2>().cast<double>());
      if (!exact_px) continue;
      uvu_px.z() = uvu_px.x() - static_cast<float>(*exact_px);
    }
    observations.push_back({uvu_px, static_cast<float>(options_.dense_map.weight), point.sigma_px});
  }
  observations.shrink_to_fit();  // kept for long
}

/// Finds the newest key frame's pose by the local map.
void BackEnd::register_map(std::optional<LoopLink>& link) {
  const std::optional<MapSight> sight = map_registration_->match(places_);
  if (!sight) return;
  const auto newest = static_cast<int>(frames_.size()) - 1;
  const Tie from = places_.standing(sight->from_key_frame);
  const RelativeMotion seen = RelativeMotion{from.T_place_left, from.covariance} *
                              RelativeMotion{sight->T_from_to, sight->covariance};
  if (!places_.recognise({from.place, newest, seen.T_from_to, seen.covariance}, false)) return;
  link = LoopLink{LinkKind::kMap,    frames_[sight->from_key_frame],
                  frames_[newest],   sight->T_from_to,
                  sight->covariance, sight->cells};
}

std::optional<LoopLink> BackEnd::ask_oracle(int64_t frame) const {
  constexpr double kExact = 1e-4;  // metres and radians; an edge of no uncertainty has no information
  std::optional<LoopLink> nearest;
  for (const int key_frame : stored_places_) {
    const int64_t from = frames_[key_frame];
    if (from > frame - options_.loop.min_age_frames) break;
    const std::optional<Pose> T_from_to = exact_loops_->loop_T_from_to(from, frame);
    if (!T_from_to) continue;
    if (nearest && nearest->T_from_to.translation().norm() <= T_from_to->translation().norm()) continue;
    nearest = LoopLink{LinkKind::kLandmarks, from, frame, *T_from_to, kExact * kExact * Matrix6d::Identity()};
  }
  return nearest;
}

int BackEnd::key_frame_of(int64_t frame) const {
  return static_cast<int>(std::lower_bound(frames_.begin(), frames_.end(), frame) - frames_.begin());
}

BackEndAnswer BackEnd::answer() const {
  BackEndAnswer answer;
  answer.key_frame = static_cast<int>(frames_.size()) - 1;
  answer.tie = places_.tie();
  answer.T_map_odom = places_.T_map_odom();
  return answer;
}

}  // namespace groundloop::slam
