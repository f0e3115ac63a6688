#pragma once

#include <array>
#include <cstdint>

#include "sim/robot/planned_path.h"
#include "sim/robot/pose2.h"
#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// Wheel odometry: quantised encoder counts turned into a pose by a robot's slightly wrong idea of itself.
/// Systematic errors as in UMBmark (Borenstein and Feng, T-RA 12(6) 1996): unequal wheel diameters taken as
/// equal (E_d), a wrong track (E_b). Random: each wheel's way gets Gaussian noise of variance proportional to
/// its length, keyed by (seed, wheel, update), so that a copy of an Odometry continues exactly as the
/// original would.
class Odometry {
 public:
  /// @param left_rad, right_rad  wheel angles at the start, where the odometry pose is zero
  Odometry(const OdometryModel& model, const DriveLimits& drive, uint64_t seed, double left_rad,
           double right_rad);

  /// Takes in the wheel angles [rad] at a later time.
  void update(double left_rad, double right_rad);
  /// Pose since the start.
  const Pose2& T_odom_body() const { return T_odom_body_; }

 private:
  int64_t counts_of(double angle_rad) const;
  double measured_way_m(int wheel, double angle_rad);

  OdometryModel model_;
  uint64_t seed_;
  std::array<double, 2> way_m_per_count_;  ///< as the odometry believes, for left and right
  double track_m_;                         ///< as the odometry believes
  std::array<int64_t, 2> counts_;
  uint64_t updates_ = 0;
  Pose2 T_odom_body_;
};

}  // namespace groundloop::sim
