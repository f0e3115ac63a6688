#include "sim/world/walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kStride_m = 1.3;  ///< two steps
constexpr double kSwing_rad = 24 * std::numbers::pi / 180;
constexpr double kEase_m = 0.3;    ///< way at the ends over which the swing grows and fades
constexpr double kCorner_m = 0.2;  ///< before and behind a corner the person turns

}  // namespace

Walk::Walk(const Person& person)
    : at_s_(person.at_s), speed_mps_(person.speed_mps), back_and_forth_(person.back_and_forth) {
  for (const WayPoint& point : person.way) {
    const Eigen::Vector2d p(point.x_m, point.y_m);
    travelled_m_.push_back(way_.empty() ? 0 : travelled_m_.back() + (p - way_.back()).norm());
    way_.push_back(p);
  }
}

Eigen::Vector2d Walk::point(double travelled_m) const {
  const auto after = std::upper_bound(travelled_m_.begin(), travelled_m_.end(), travelled_m);
  if (after == travelled_m_.begin()) return way_.front();
  if (after == travelled_m_.end()) return way_.back();
  const auto i = static_cast<size_t>(after - travelled_m_.begin());
  const double fraction = (travelled_m - travelled_m_[i - 1]) / (travelled_m_[i] - travelled_m_[i - 1]);
  return way_[i - 1] + fraction * (way_[i] - way_[i - 1]);
}

double Walk::heading_rad(double travelled_m) const {
  const Eigen::Vector2d ahead = point(travelled_m + kCorner_m) - point(travelled_m - kCorner_m);
  return ahead.norm() > 0 ? std::atan2(ahead.y(), ahead.x()) : 0;
}

Stance Walk::at(double time_s) const {
  const double walked_m = speed_mps_ * std::max(0.0, time_s - at_s_);
  double travelled_m = std::min(walked_m, length_m());
  bool returning = false;
  if (back_and_forth_ && length_m() > 0) {
    const double round_m = std::fmod(walked_m, 2 * length_m());
    returning = round_m > length_m();
    travelled_m = returning ? 2 * length_m() - round_m : round_m;
  }
  const double from_end_m = std::min(travelled_m, length_m() - travelled_m);
  Stance stance;
  stance.p_world = point(travelled_m);
  stance.yaw_rad = heading_rad(travelled_m) + (returning ? std::numbers::pi : 0);
  stance.swing_rad = kSwing_rad * std::min(1.0, from_end_m / kEase_m) *
                     std::sin(2 * std::numbers::pi * travelled_m / kStride_m);
  return stance;
}

}  // namespace groundloop::sim
