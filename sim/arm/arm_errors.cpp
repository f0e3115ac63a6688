#include "sim/arm/arm_errors.h"

#include <cmath>
#include <numbers>

#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr uint64_t kStream = 0x41524D;  // "ARM": apart from the sensor's noise

/// In (0, 1).
double uniform(uint64_t seed, uint64_t counter) {
  return (static_cast<double>(random_bits(seed, kStream, counter) >> 11) + 0.5) * 0x1p-53;
}

/// Standard normal (Box and Muller, 1958).
double normal(uint64_t seed, uint64_t counter) {
  return std::sqrt(-2 * std::log(uniform(seed, 2 * counter))) *
         std::cos(2 * std::numbers::pi * uniform(seed, 2 * counter + 1));
}

}  // namespace

slam::Pose hand_eye_error(const HandEyeError& error) {
  // Camera axes: x right, y down, z forward. Left is a negative turn about y, up a positive one about x.
  slam::Pose T_believed_camera = slam::Pose::Identity();
  T_believed_camera.translation() << error.x_m, error.y_m, error.z_m;
  T_believed_camera.rotate(Eigen::AngleAxisd(-error.pan_deg * kDegree, Eigen::Vector3d::UnitY()));
  T_believed_camera.rotate(Eigen::AngleAxisd(error.tilt_deg * kDegree, Eigen::Vector3d::UnitX()));
  T_believed_camera.rotate(Eigen::AngleAxisd(error.roll_deg * kDegree, Eigen::Vector3d::UnitZ()));
  return T_believed_camera;
}

slam::Pose repeatability_error(const ArmErrors& errors, uint64_t seed, int64_t stop) {
  slam::Vector6d twist;
  for (int axis = 0; axis < 6; ++axis) {
    const double sigma = axis < 3 ? errors.repeatability_m : errors.repeatability_deg * kDegree;
    twist[axis] = sigma * normal(seed, 6 * static_cast<uint64_t>(stop) + static_cast<uint64_t>(axis));
  }
  return slam::se3_exp(twist);
}

}  // namespace groundloop::sim
