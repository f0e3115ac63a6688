#include "sim/faults/head_faults.h"

#include <numbers>

namespace groundloop::sim {

double trigger_offset_s(const std::vector<Fault>& faults, double time_s) {
  double offset_s = 0;
  for (const Fault& fault : faults) {
    if (fault.trigger_offset && fault.active(time_s)) offset_s += fault.trigger_offset->right_s;
  }
  return offset_s;
}

slam::Pose T_calibrated_right(const std::vector<Fault>& faults, double time_s) {
  // camera axes: x right, y down, z forward
  const auto turn = [](double angle_deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis);
  };
  slam::Pose T = slam::Pose::Identity();
  for (const Fault& fault : faults) {
    if (!fault.knock || !fault.active(time_s)) continue;
    T = T * turn(-fault.knock->pan_deg, Eigen::Vector3d::UnitY()) *
        turn(fault.knock->tilt_deg, Eigen::Vector3d::UnitX()) *
        turn(fault.knock->roll_deg, Eigen::Vector3d::UnitZ());
  }
  return T;
}

}  // namespace groundloop::sim
