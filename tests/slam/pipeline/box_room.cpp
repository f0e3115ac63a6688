#include "tests/slam/pipeline/box_room.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace groundloop::slam {
namespace {

constexpr double kStep_m = 0.03;
constexpr double kTurn_rad = 1.5 * std::numbers::pi / 180;
const Eigen::Vector3d kLow(-3, -2.5, 0), kHigh(3, 2.5, 2.5);
constexpr double kNoise_grey = 1.0;

int64_t stamp_of(int64_t index) { return 1000000000 + index * 133333333; }

}  // namespace

BoxRoom::BoxRoom(int scale) {
  rig_.width_px = 320 * scale;
  rig_.height_px = 240 * scale;
  rig_.fx_px = rig_.fy_px = 288 * scale;
  rig_.cx_px = rig_.cx_right_px = 160 * scale - 0.5;
  rig_.cy_px = 120 * scale - 0.5;
  rig_.baseline_m = 0.12;
  rig_.T_body_left = StereoRig::level_camera({0.1, 0.06, 0.35});
}

Pose BoxRoom::T_world_body(double step) const {
  const double radius_m = kStep_m / kTurn_rad, angle = kTurn_rad * step;
  Pose T = Pose::Identity();
  T.translation() << -1 + radius_m * std::sin(angle), -0.5 + radius_m * (1 - std::cos(angle)), 0;
  T.linear() = so3_exp({0, 0, angle});
  return T;
}

Pose BoxRoom::T_map_left(double step) const {
  return T_world_body(0).inverse() * T_world_body(step) * rig_.T_body_left;
}

cv::Mat BoxRoom::render(const Pose& T_world_camera, uint64_t seed) const {
  const Eigen::Vector3d eye = T_world_camera.translation();
  return draw({rig_.width_px, rig_.height_px}, {1, 0, kNoise_grey, seed}, [&](int u, int v) {
    const Eigen::Vector3d ray = T_world_camera.linear() * Eigen::Vector3d((u - rig_.cx_px) / rig_.fx_px,
                                                                          (v - rig_.cy_px) / rig_.fy_px, 1);
    double range = 1e9;  // from inside, the nearest wall ahead along any axis
    for (int axis = 0; axis < 3; ++axis) {
      if (ray(axis) != 0) {
        range = std::min(range, ((ray(axis) > 0 ? kHigh : kLow)(axis)-eye(axis)) / ray(axis));
      }
    }
    return paint_.at(eye + range * ray);
  });
}

StereoFrame BoxRoom::frame(int64_t index, double step, double before, bool with_plan) const {
  const Pose T_world_left = T_world_body(step) * rig_.T_body_left;
  const auto seed = static_cast<uint64_t>(2 * index);
  StereoFrame frame;
  frame.index = index;
  frame.stamp_ns = stamp_of(index);
  frame.left = render(T_world_left, seed);
  frame.right = render(T_world_left * Eigen::Translation3d(rig_.baseline_m, 0, 0), seed + 1);
  if (with_plan) frame.T_previous_left = T_map_left(before).inverse() * T_map_left(step);
  return frame;
}

StereoFrame BoxRoom::dark_frame(int64_t index) const {
  const auto step = static_cast<double>(index);
  StereoFrame frame;
  frame.index = index;
  frame.stamp_ns = stamp_of(index);
  frame.left = frame.right = cv::Mat(rig_.height_px, rig_.width_px, CV_8UC1, cv::Scalar(128));
  frame.T_previous_left = T_map_left(step - 1).inverse() * T_map_left(step);
  return frame;
}

}  // namespace groundloop::slam
