#pragma once

#include <cstdint>
#include <vector>

#include "slam/adjustment/adjustment_problem.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// The head of a Pioneer: 640 x 480, 577 px, 88 mm, 0.35 m above the floor.
StereoRig pioneer_rig();

/// What a window is made of.
struct WindowRecipe {
  int key_frames = 8;
  int landmarks = 150;
  double sigma_px = 0.2;         ///< of the noise in the images
  double stated_sigma_px = 0.2;  ///< that the adjustment is told
  double pair_sigma_m = 0;       ///< right camera beside its place, anew in every key frame
  double pair_sigma_rad = 0;     ///< the same of its turn about each axis
  double outliers = 0;           ///< share of observations that are off by up to 20 px
  double start_error = 1;        ///< 1: first poses off by about 5 mm and 0.2 degrees
  uint64_t seed = 1;
};

struct SyntheticWindow {
  AdjustmentProblem problem;  ///< first key frame fixed at the truth, the rest off
  std::vector<Pose> T_odom_left;
  std::vector<Eigen::Vector3d> landmarks_odom;
  std::vector<uint8_t> is_outlier;  ///< per observation
};

/// A drive along an arc, 0.2 m and 2.5 degrees between key frames, landmarks 1 to 9 m before it. Each
/// landmark is seen from the key frame that found it on, until it leaves the picture or is lost: five times
/// on average.
SyntheticWindow make_window(const StereoRig& rig, const WindowRecipe& recipe);

/// (u_left, v, u_right) of a point when the right camera is off its place by a twist on its right: the row is
/// the mean of both images'.
Eigen::Vector3d project_with(const StereoRig& rig, const Vector6d& right_off, const Eigen::Vector3d& p_left);

/// Left camera of an error-free drive at key frame k, on the floor plane z = 0 of odom.
Pose drive(const StereoRig& rig, int k);

}  // namespace groundloop::slam
