#pragma once

#include <memory>
#include <optional>

#include "sim/simulation/simulation.h"

namespace groundloop::sim {

/// An arm that carries one camera and stops twice for every pair, the second time one baseline to the right.
///
/// Pair k is stamped k times the head's period, within which the arm must have stood twice. Both images see
/// the world as it is then, but for the arm itself. The truth is where the camera stood for the left image;
/// what the core is told is the planned motion. Errors of the arm (robot.arm) come between the two: a
/// hand-eye error is the same at every stop, repeatability is drawn for each by (seed, stop).
class ArmSimulation : public HeadCarrier {
 public:
  /// @throws InputError when the robot is no arm, or the plan out of reach or not clear of everything
  ArmSimulation(const World& world, const HeadModel& head, const Scenario& scenario);
  ~ArmSimulation() override;

  /// @throws InputError when the arm does not come to rest in time
  std::optional<Exposure> advance() override;
  int64_t exposure_count() const override;
  double planned_length_m() const override;
  slam::Pose planned_T_world_body(double time_s) const override;
  double planned_duration_s() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
