#include "sim/robot/planned_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace groundloop::sim {
namespace {

double radians(double deg) { return deg * std::numbers::pi / 180; }

/// Signed way and turn of a segment; stops and looks have neither.
std::pair<double, double> motion_of(const Segment& segment) {
  if (segment.straight_m) return {*segment.straight_m, 0};
  if (!segment.arc) return {0, 0};
  const double turn_rad = radians(segment.arc->angle_deg);
  return {segment.arc->radius_m * std::abs(turn_rad), turn_rad};
}

/// The fastest ramp over a motion that keeps to the plan's speeds and the wheels' limits.
SpeedRamp ramp_for(double length_m, double turn_rad, const Plan& plan, const DriveLimits& limits) {
  const double wheel_rad = (std::abs(length_m) + std::abs(turn_rad) * limits.track_m / 2) /
                           limits.wheel_radius_m;  // of the outer wheel
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto at_most = [](double limit, double amount) { return amount > 0 ? limit / amount : kNone; };
  const double rate = std::min({at_most(plan.speed_mps, std::abs(length_m)),
                                at_most(radians(plan.turn_rate_limit_degps), std::abs(turn_rad)),
                                at_most(limits.wheel_speed_radps, wheel_rad)});
  return {rate, at_most(limits.wheel_acceleration_radps2, wheel_rad)};
}

/// The fastest ramp between two directions of the head, both axes at once.
SpeedRamp ramp_for(const HeadAngles& from, const HeadAngles& to, const Plan& plan,
                   double look_acceleration_radps2) {
  const double way_rad = std::max(std::abs(to.pan_rad - from.pan_rad), std::abs(to.tilt_rad - from.tilt_rad));
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (way_rad == 0) return {kNone, kNone};
  return {radians(plan.look_speed_degps) / way_rad, look_acceleration_radps2 / way_rad};
}

/// A part of the way from one direction of the head to another.
HeadAngles between(const HeadAngles& from, const HeadAngles& to, double fraction) {
  return {from.pan_rad + fraction * (to.pan_rad - from.pan_rad),
          from.tilt_rad + fraction * (to.tilt_rad - from.tilt_rad)};
}

HeadAngles turned_at(const HeadAngles& from, const HeadAngles& to, double rate) {
  return {rate * (to.pan_rad - from.pan_rad), rate * (to.tilt_rad - from.tilt_rad)};
}

}  // namespace

SpeedRamp::SpeedRamp(double rate_limit, double acceleration)
    : rate_(std::min(rate_limit, std::sqrt(acceleration))), acceleration_(acceleration) {
  const bool moves = std::isfinite(acceleration_);
  ramp_s_ = moves ? rate_ / acceleration_ : 0;
  cruise_s_ = moves ? std::max(0.0, (1 - rate_ * ramp_s_) / rate_) : 0;
}

double SpeedRamp::progress(double time_s) const {
  const double left_s = duration_s() - time_s;
  if (left_s <= 0) return 1;
  if (time_s <= 0) return 0;
  if (time_s < ramp_s_) return acceleration_ * time_s * time_s / 2;
  if (left_s < ramp_s_) return 1 - acceleration_ * left_s * left_s / 2;
  return rate_ * (time_s - ramp_s_ / 2);
}

double SpeedRamp::rate(double time_s) const {
  const double left_s = duration_s() - time_s;
  if (time_s <= 0 || left_s <= 0) return 0;
  return std::min({rate_, acceleration_ * time_s, acceleration_ * left_s});
}

PlannedPath::PlannedPath(const StartPose& start, const Plan& plan, const DriveLimits& limits,
                         double look_acceleration_radps2)
    : T_world_end_{start.x_m, start.y_m, radians(start.yaw_deg)} {
  for (const Segment& segment : plan.segments) {
    const auto [length_m, turn_rad] = motion_of(segment);
    HeadAngles head = head_end_;
    if (segment.look) head = {radians(segment.look->pan_deg), radians(segment.look->tilt_deg)};
    const SpeedRamp ramp = segment.look ? ramp_for(head_end_, head, plan, look_acceleration_radps2)
                                        : ramp_for(length_m, turn_rad, plan, limits);
    const double segment_s = segment.stop_s.value_or(ramp.duration_s());
    pieces_.push_back({T_world_end_, length_m, turn_rad, duration_s_, segment_s, ramp, head_end_, head});
    head_end_ = head;
    T_world_end_ = driven(T_world_end_, length_m, turn_rad);
    duration_s_ += segment_s;
    length_m_ += std::abs(length_m);
  }
}

double PlannedPath::segment_length_m(size_t segment) const { return pieces_.at(segment).length_m; }
double PlannedPath::segment_turn_rad(size_t segment) const { return pieces_.at(segment).turn_rad; }

Pose2 PlannedPath::at_fraction(size_t segment, double fraction) const {
  const Piece& piece = pieces_.at(segment);
  return driven(piece.T_world_start, fraction * piece.length_m, fraction * piece.turn_rad);
}

PlannedState PlannedPath::at(double time_s) const {
  if (pieces_.empty()) return {T_world_end_, {}, 0, 0, {}, {}};
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), time_s,
                                      [](double t_s, const Piece& piece) { return t_s < piece.start_s; });
  const auto segment = static_cast<size_t>(after - pieces_.begin()) - 1;
  const Piece& piece = pieces_[segment];
  const double within_s = time_s - piece.start_s;
  const double rate = piece.ramp.rate(within_s);
  const double fraction = piece.ramp.progress(within_s);
  return {at_fraction(segment, fraction),
          {rate * piece.length_m, rate * piece.turn_rad},
          segment,
          fraction,
          between(piece.head_start, piece.head_end, fraction),
          turned_at(piece.head_start, piece.head_end, rate)};
}

}  // namespace groundloop::sim
