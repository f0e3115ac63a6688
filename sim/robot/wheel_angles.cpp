#include "sim/robot/wheel_angles.h"

namespace groundloop::sim {

WheelFaults wheel_faults(const DriveErrors& errors, const std::vector<Fault>& faults, double time_s) {
  const double e = errors.diameter_ratio;
  WheelFaults wheels{{2 / (e + 1), 2 * e / (e + 1)}, {1, 1}};
  for (const Fault& fault : faults) {
    if (!fault.active(time_s)) continue;
    if (fault.wheel_slip) {
      wheels.grip[0] *= 1 - fault.wheel_slip->left;
      wheels.grip[1] *= 1 - fault.wheel_slip->right;
    }
    if (fault.encoder) {
      wheels.counted[0] *= fault.encoder->left;
      wheels.counted[1] *= fault.encoder->right;
    }
  }
  return wheels;
}

void WheelAngles::update(const std::array<double, 2>& rolled_rad, const WheelFaults& faults) {
  for (size_t wheel = 0; wheel < 2; ++wheel) {
    const double turned_rad = (rolled_rad[wheel] - rolled_rad_[wheel]) / faults.grip[wheel];
    slipped_rad_[wheel] += turned_rad * (1 - faults.grip[wheel]);
    missed_rad_[wheel] += turned_rad * (1 - faults.counted[wheel]);
    rolled_rad_[wheel] = rolled_rad[wheel];
  }
}

}  // namespace groundloop::sim
