#include "slam/pipeline/repeated_pair.h"

#include <cstring>

namespace groundloop::slam {
namespace {

// Far less than shows in an image, far more than rounding makes of standing still.
constexpr double kStill_m = 1e-4;
constexpr double kStill_rad = 1e-4;

bool stands_still(const Pose& T_previous_left) {
  return T_previous_left.translation().norm() < kStill_m &&
         rotation_angle_rad(T_previous_left.linear()) < kStill_rad;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return false;
  for (int v = 0; v < a.rows; ++v) {
    if (std::memcmp(a.ptr(v), b.ptr(v), static_cast<size_t>(a.cols)) != 0) return false;
  }
  return true;
}

}  // namespace

bool RepeatedPair::is(const StereoFrame& frame) {
  if (same_bytes(frame.left, left_) && same_bytes(frame.right, right_)) {
    return frame.T_previous_left && !stands_still(*frame.T_previous_left);
  }
  frame.left.copyTo(left_);
  frame.right.copyTo(right_);
  return false;
}

}  // namespace groundloop::slam
