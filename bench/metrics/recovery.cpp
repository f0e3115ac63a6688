#include "bench/metrics/recovery.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace groundloop::bench {
namespace {

using slam::TrackingStatus;

struct Tolerance {
  double distance_m;
  double angle_deg;
};
constexpr Tolerance kRight{0.1, 2};
constexpr Tolerance kJump{0.1, 5};  ///< more is no step that goes by itself, neither true nor estimated

bool agree(const slam::Pose& T_a, const slam::Pose& T_b, const Tolerance& tolerance) {
  const slam::Pose difference = T_a.inverse() * T_b;
  return difference.translation().norm() <= tolerance.distance_m &&
         slam::rotation_angle_rad(difference.linear()) * 180 / std::numbers::pi <= tolerance.angle_deg;
}

}  // namespace

void RecoveryJudge::observe(const JudgedFrame& frame, const std::function<std::vector<MappedView>()>& map) {
  const slam::FrameResult& result = frame.result;
  const bool lost = result.status == TrackingStatus::kLost;
  bool carried_away = false;
  if (before_) {
    const slam::Pose T_true_step = before_->T_world_left.inverse() * frame.T_world_left;
    carried_away = frame.T_previous_left && !agree(*frame.T_previous_left, T_true_step, kJump);
    const slam::Pose T_step = before_->T_map_left.inverse() * result.T_map_left;
    const bool noted = result.status != TrackingStatus::kTracking || carried_away ||
                       before_->status == TrackingStatus::kLost || before_->segment != result.segment ||
                       !result.links.empty();
    if (!noted && !agree(T_step, T_true_step, kJump)) ++silent_jumps_;
  }
  before_ = Before{result.status, result.segment, result.T_map_left, frame.T_world_left};

  if (carried_away || (lost && !open_)) {
    interruptions_ += open_ ? 0 : 1;
    open_ = Interruption{result.index, result.stamp_ns};
  }
  if (open_ && !lost && right_in_map(frame, map())) {
    longest_s_ = std::max(longest_s_, 1e-9 * static_cast<double>(result.stamp_ns - open_->stamp_ns));
    open_.reset();
  }
}

bool RecoveryJudge::right_in_map(const JudgedFrame& frame, const std::vector<MappedView>& map) const {
  const MappedView* nearest = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const MappedView& view : map) {
    const double distance_m = (view.T_world_left.translation() - frame.T_world_left.translation()).norm();
    if (view.frame >= open_->frame || distance_m >= nearest_m) continue;
    nearest = &view;
    nearest_m = distance_m;
  }
  if (nearest == nullptr) return true;  // there was no map to be right in
  return agree(nearest->T_map_left.inverse() * frame.result.T_map_left,
               nearest->T_world_left.inverse() * frame.T_world_left, kRight);
}

Metrics RecoveryJudge::metrics() const {
  if (!before_) return {};
  Metrics metrics = {{"tracking.interruptions", interruptions_}, {"tracking.silent_jumps", silent_jumps_}};
  if (interruptions_ > 0 && !open_) metrics["tracking.relocalised_s"] = longest_s_;
  return metrics;
}

}  // namespace groundloop::bench
