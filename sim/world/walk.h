#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scenario/scenery.h"

namespace groundloop::sim {

/// How a person stands at one moment.
struct Stance {
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();  ///< on the floor [m]
  double yaw_rad = 0;                                 ///< looks along the way
  double swing_rad = 0;  ///< left leg forward of upright, the right one as far back
};

/// A person's way in time, in closed form: along straight lines at one speed. Looks where the way leads,
/// rounding corners; legs swing one stride of 1.3 m a period, and come to rest at the ends.
class Walk {
 public:
  explicit Walk(const Person& person);
  Stance at(double time_s) const;
  double length_m() const { return travelled_m_.back(); }
  /// Point of the way after some length of it.
  Eigen::Vector2d point(double travelled_m) const;

 private:
  double heading_rad(double travelled_m) const;

  double at_s_, speed_mps_;
  bool back_and_forth_;
  std::vector<Eigen::Vector2d> way_;
  std::vector<double> travelled_m_;  ///< at each point of the way
};

}  // namespace groundloop::sim
