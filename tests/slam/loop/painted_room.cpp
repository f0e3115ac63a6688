#include "tests/slam/loop/painted_room.h"

#include <cmath>

#include "slam/features/detector.h"
#include "slam/stereo/disparity.h"
#include "slam/types/stereo_uncertainty.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

const Eigen::Vector3d kLow(-20, -3, 0), kHigh(20, PaintedRoom::kFarWall_m, 2.5);
const KltOptions kKlt;

}  // namespace

StereoRig PaintedRoom::rig() { return centred_rig(320, 240, 288, 0.12); }

Pose PaintedRoom::T_room_left(double x_m, double y_m, double yaw_deg) {
  Pose T_room_body = Pose::Identity();
  T_room_body.translation() << x_m, y_m, 1.2;
  T_room_body.linear() = so3_exp({0, 0, yaw_deg * std::numbers::pi / 180});
  return T_room_body * StereoRig::level_camera(Eigen::Vector3d::Zero());
}

double PaintedRoom::paint(Eigen::Vector3d p) const {
  const auto edged = [](double grey) { return 128 + 60 * std::tanh((grey - 128) / 15); };
  if (p.y() > kFarWall_m - 1e-6) {
    for (const Eigen::Vector3d& centre : look_.posters) {
      const Eigen::Vector3d offset = p - centre;
      if (std::abs(offset.x()) < 0.6 && std::abs(offset.z()) < 0.6) return edged(picture_.at(offset));
    }
  }
  if (look_.period_m > 0) p.x() -= look_.period_m * std::floor(p.x() / look_.period_m);
  return edged(walls_.at(p));
}

cv::Mat PaintedRoom::render(const Pose& T_room_camera, const Light& light) const {
  const StereoRig r = rig();
  const Eigen::Vector3d eye = T_room_camera.translation();
  return draw({r.width_px, r.height_px}, light, [&](int u, int v) {
    const Eigen::Vector3d ray =
        T_room_camera.linear() * Eigen::Vector3d((u - r.cx_px) / r.fx_px, (v - r.cy_px) / r.fy_px, 1);
    double range = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      if (ray(axis) != 0) {
        range = std::min(range, ((ray(axis) > 0 ? kHigh : kLow)(axis)-eye(axis)) / ray(axis));
      }
    }
    return paint(eye + range * ray);
  });
}

LoopKeyFrame PaintedRoom::key_frame(int64_t index, const Pose& T_room_left, const Light& light) const {
  Light left_light = light, right_light = light;
  left_light.seed = random_bits(seed_, 0, static_cast<uint64_t>(index));
  right_light.seed = random_bits(seed_, 1, static_cast<uint64_t>(index));
  DetectionOptions detection;
  detection.min_distance_px = 8;
  return make_key_frame(rig(), index, render(T_room_left, left_light),
                        render(T_room_left * Eigen::Translation3d(rig().baseline_m, 0, 0), right_light),
                        detection);
}

LoopKeyFrame make_key_frame(const StereoRig& rig, int64_t index, const cv::Mat& left, const cv::Mat& right,
                            const DetectionOptions& detection) {
  DenseDisparity dense(DisparityOptions{});
  dense.compute(left, right);
  LoopKeyFrame key_frame;
  key_frame.index = index;
  key_frame.left = left;
  key_frame.right = right;
  key_frame.half_disparity = dense.half_resolution();
  ImagePyramid left_pyramid, right_pyramid;
  left_pyramid.build(left, kKlt.levels);
  right_pyramid.build(right, kKlt.levels);
  const StereoMatcher matcher(rig, StereoOptions{}, kKlt);
  Detector detector(detection);
  PatchTemplate patch;
  for (const Eigen::Vector2f& corner : detector.detect(left, {}, 400, 18)) {
    if (!patch.take(left_pyramid, corner, kKlt.levels)) continue;
    AffineState state;
    state.uv_px = corner;
    const auto match = matcher.match(patch, state, dense, right_pyramid);
    if (!match || !matcher.plausible(corner, match->uv_px)) continue;
    const Eigen::Vector3d uvu = optimal_measurement(corner, match->uv_px);
    const double variance = point_covariance(rig, uvu, RegistrationOptions{}.sigma_px)(2, 2);
    key_frame.landmarks.push_back(
        {corner, static_cast<float>(rig.triangulate(uvu)->z()), static_cast<float>(std::sqrt(variance))});
  }
  return key_frame;
}

LoopVerifier make_verifier(const LoopOptions& options) {
  return {PaintedRoom::rig(), options, kKlt, StereoOptions{}, RegistrationOptions{}};
}

LoopDetector make_detector(const LoopOptions& options) {
  return {PaintedRoom::rig(), options, kKlt, StereoOptions{}, RegistrationOptions{}, 1};
}

CurrentView current_view(const LoopKeyFrame& key_frame) {
  CurrentView current;
  current.view = {key_frame.index, key_frame.left, key_frame.landmarks, {}};
  current.half_disparity = key_frame.half_disparity;
  current.left.build(key_frame.left, kKlt.levels);
  current.right.build(key_frame.right, kKlt.levels);
  Describer(LoopOptions{}.descriptors)
      .describe(key_frame.left, key_frame.half_disparity, current.view.keypoints);
  return current;
}

}  // namespace groundloop::slam
