#include "slam/pipeline/back_end.h"

#include <algorithm>
#include <chrono>

namespace groundloop::slam {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

BackEnd::BackEnd(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle)
    : options_(options),
      oracle_(oracle != nullptr && oracle->replaces(OracleStage::kLoops) ? oracle : nullptr),
      detector_(rig, options.loop, options.klt, options.stereo, options.registration, options.seed),
      map_(rig, options.mapping, options.key_frame.looks_kept) {}

BackEndAnswer BackEnd::process(HandedOver handed_over) {
  const Clock::time_point start = Clock::now();
  frames_.push_back(handed_over.sight.index);
  places_.advance(handed_over.pose, handed_over.known_better);
  if (handed_over.starts_segment) places_.start(handed_over.T_map_left);
  std::optional<LoopLink> link;
  recognise(handed_over, link);
  const double loop_ms = milliseconds_since(start);

  const Tie here = places_.standing(handed_over.pose.key_frame);
  handed_over.look.key_frame = here.key_frame;
  handed_over.look.place = here.place;
  handed_over.look.T_place_left = here.T_place_left;
  map_.add(std::move(handed_over.look), places_.T_map_place());

  BackEndAnswer result = answer();
  result.link = link;
  result.loop_ms = loop_ms;
  result.mapping_ms = milliseconds_since(start) - loop_ms;
  return result;
}

BackEndAnswer BackEnd::finish(const std::vector<OdometryPose>& known_better) {
  places_.refine(known_better);
  map_.complete(places_.T_map_place());
  return answer();
}

void BackEnd::recognise(const HandedOver& handed_over, std::optional<LoopLink>& link) {
  bool is_place = true;
  if (oracle_ != nullptr) {
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

std::optional<LoopLink> BackEnd::ask_oracle(int64_t frame) const {
  constexpr double kExact = 1e-4;  // metres and radians; an edge of no uncertainty has no information
  std::optional<LoopLink> nearest;
  for (const int key_frame : stored_places_) {
    const int64_t from = frames_[key_frame];
    if (from > frame - options_.loop.min_age_frames) break;
    const std::optional<Pose> T_from_to = oracle_->loop_T_from_to(from, frame);
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
