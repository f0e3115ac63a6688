#include "tests/slam/adjustment/synthetic_window.h"

#include <numbers>

#include "tests/slam/features/texture.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

/// Three normal deviates; streams do not meet as long as they differ.
Eigen::Vector3d gaussian3(uint64_t seed, uint64_t stream, uint64_t counter) {
  return {gaussian(seed, 3 * stream, counter), gaussian(seed, 3 * stream + 1, counter),
          gaussian(seed, 3 * stream + 2, counter)};
}

bool in_picture(const StereoRig& rig, const Eigen::Vector3d& p_left) {
  if (p_left.z() < 0.5) return false;
  const Eigen::Vector3d uvu = rig.project(p_left);
  return uvu.z() > 5 && uvu.x() < rig.width_px - 5 && uvu.y() > 5 && uvu.y() < rig.height_px - 5;
}

}  // namespace

StereoRig pioneer_rig() {
  StereoRig rig = centred_rig(640, 480, 577, 0.088);
  rig.T_body_left = StereoRig::level_camera({0.1, 0.044, 0.35});
  return rig;
}

Eigen::Vector3d project_with(const StereoRig& rig, const Vector6d& right_off, const Eigen::Vector3d& p_left) {
  const Pose T_left_right = Eigen::Translation3d(rig.baseline_m, 0, 0) * se3_exp(right_off);
  const Eigen::Vector3d left = rig.project(p_left), p_right = T_left_right.inverse() * p_left;
  const double v_right = rig.fy_px * p_right.y() / p_right.z() + rig.cy_px;
  return {left.x(), 0.5 * (left.y() + v_right), rig.fx_px * p_right.x() / p_right.z() + rig.cx_right_px};
}

Pose drive(const StereoRig& rig, int k) {
  const double yaw = 2.5 * std::numbers::pi / 180 * k, radius_m = 0.2 / (2.5 * std::numbers::pi / 180);
  Pose T_odom_body = Pose::Identity();
  T_odom_body.linear() = so3_exp({0, 0, yaw});
  T_odom_body.translation() << radius_m * std::sin(yaw), radius_m * (1 - std::cos(yaw)), 0;
  return T_odom_body * rig.T_body_left;
}

SyntheticWindow make_window(const StereoRig& rig, const WindowRecipe& recipe) {
  const uint64_t seed = recipe.seed;
  SyntheticWindow window;
  const auto right_off = [&](int k) {
    Vector6d off;
    off << recipe.pair_sigma_m * gaussian3(seed, 200, static_cast<uint64_t>(k)),
        recipe.pair_sigma_rad * gaussian3(seed, 201, static_cast<uint64_t>(k));
    return off;
  };
  for (int k = 0; k < recipe.key_frames; ++k) {
    window.T_odom_left.push_back(drive(rig, k));
    const auto counter = static_cast<uint64_t>(k);
    Vector6d off;
    off << 0.005 * gaussian3(seed, 100, counter), 0.0035 * gaussian3(seed, 101, counter);
    const Pose start = window.T_odom_left.back() * se3_exp(recipe.start_error * off);
    window.problem.key_frames.push_back({k == 0 ? window.T_odom_left.back() : start, k == 0});
  }
  for (uint64_t j = 0; static_cast<int>(window.landmarks_odom.size()) < recipe.landmarks; ++j) {
    // as many are older than the window as are found in it
    const int found = std::max(0, static_cast<int>((2 * uniform(seed, 1, j) - 1) * recipe.key_frames));
    const double z = 1 + 8 * uniform(seed, 2, j);
    const Eigen::Vector3d p_left((uniform(seed, 3, j) - 0.5) * 640 / 577 * z,
                                 (uniform(seed, 4, j) - 0.5) * 480 / 577 * z, z);
    const Eigen::Vector3d p_odom = window.T_odom_left[static_cast<size_t>(found)] * p_left;
    const int landmark = static_cast<int>(window.landmarks_odom.size());
    bool seen = false;
    for (int k = found; k < recipe.key_frames; ++k) {
      const Pose& T_odom_left = window.T_odom_left[static_cast<size_t>(k)];
      const Eigen::Vector3d p = T_odom_left.inverse() * p_odom;
      const uint64_t counter = 64 * j + static_cast<uint64_t>(k);
      if (!in_picture(rig, p) || (seen && uniform(seed, 5, counter) < 0.03)) break;
      const Eigen::Vector3d scale(1, std::numbers::sqrt2 / 2, 1);
      Eigen::Vector3d uvu = project_with(rig, right_off(k), p) +
                            recipe.sigma_px * scale.cwiseProduct(gaussian3(seed, 102, counter));
      const bool outlier = uniform(seed, 6, counter) < recipe.outliers;
      if (outlier)
        uvu += 20 * Eigen::Vector3d(uniform(seed, 7, counter) - 0.5, uniform(seed, 8, counter) - 0.5,
                                    uniform(seed, 9, counter) - 0.5);
      if (!seen) {
        // Where the first view puts it, under the first guess of the pose: as a tracker would.
        const Eigen::Vector3d start = rig.triangulate(uvu).value_or(p);
        const Eigen::Vector3d blend = recipe.start_error > 0 ? start : p;
        window.problem.landmarks_odom.push_back(
            window.problem.key_frames[static_cast<size_t>(k)].T_odom_left * blend);
        window.landmarks_odom.push_back(p_odom);
        seen = true;
      }
      window.problem.observations.push_back({k, landmark, uvu, recipe.stated_sigma_px});
      window.is_outlier.push_back(outlier ? 1 : 0);
    }
  }
  return window;
}

}  // namespace groundloop::slam
