#include "sim/truth/image_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest_m = 1000;
constexpr double kMoves_m = 1e-6;
constexpr double kHiding = 1e-3;  ///< of its depth: how much nearer a surface must be to hide a point

Vector3d ray(const ImageTruth& view, double u_px, double v_px) {
  return {(u_px - view.cx_px) / view.focal_px, (v_px - view.cy_px) / view.focal_px, 1};
}

/// Whether the image shows a point that falls on (u, v) at depth z: the pixels round it show nothing nearer
/// than it, or at least one of them shows as much as it.
bool shows(const ImageTruth& view, double u_px, double v_px, double z_m) {
  if (u_px < -0.5 || v_px < -0.5 || u_px >= view.depth_m.cols - 0.5 || v_px >= view.depth_m.rows - 0.5)
    return false;
  double farthest_m = 0;
  for (const int du : {0, 1}) {
    for (const int dv : {0, 1}) {
      const int u = std::clamp(cvFloor(u_px) + du, 0, view.depth_m.cols - 1);
      const int v = std::clamp(cvFloor(v_px) + dv, 0, view.depth_m.rows - 1);
      farthest_m = std::max<double>(farthest_m, view.depth_m.at<float>(v, u));
    }
  }
  return z_m <= farthest_m * (1 + kHiding);
}

}  // namespace

std::vector<slam::Pose> geom_poses(const mjModel& model, const mjData& state) {
  std::vector<slam::Pose> poses(static_cast<size_t>(model.ngeom), slam::Pose::Identity());
  for (int geom = 0; geom < model.ngeom; ++geom) {
    slam::Pose& T_world_geom = poses[static_cast<size_t>(geom)];
    T_world_geom.translation() = Eigen::Map<const Vector3d>(state.geom_xpos + 3 * geom);
    T_world_geom.linear() =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.geom_xmat + 9 * geom);
  }
  return poses;
}

void cast_image_truth(const TruthWorld& truth, cv::Size size, ImageTruth& view) {
  view.depth_m.create(size, CV_32FC1);
  view.geom.create(size, CV_32SC1);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const Vector3d ray_camera = ray(view, u, v);
      const auto hit = truth.cast(view.T_world_camera.translation(),
                                  view.T_world_camera.linear() * ray_camera, kFarthest_m);
      view.depth_m.at<float>(v, u) = hit ? static_cast<float>(hit->distance_m / ray_camera.norm())
                                         : std::numeric_limits<float>::infinity();
      view.geom.at<int>(v, u) = hit ? hit->geom : -1;
    }
  }
}

cv::Mat true_disparity_px(const ImageTruth& left, double baseline_m) {
  cv::Mat disparity_px(left.depth_m.size(), CV_32FC1);
  for (int v = 0; v < disparity_px.rows; ++v) {
    for (int u = 0; u < disparity_px.cols; ++u) {
      // an infinite depth gives 0
      disparity_px.at<float>(v, u) =
          static_cast<float>(left.focal_px * baseline_m / left.depth_m.at<float>(v, u));
    }
  }
  return disparity_px;
}

ImageMotion image_motion(const ImageTruth& from, const ImageTruth& to) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const cv::Size size = from.depth_m.size();
  ImageMotion motion{cv::Mat(size, CV_32FC2, cv::Scalar(kNone, kNone)), cv::Mat::zeros(size, CV_8UC1),
                     cv::Mat::zeros(size, CV_8UC1)};
  const slam::Pose T_to_world = to.T_world_camera.inverse();
  std::vector<slam::Pose> T_after_before(from.T_world_geom.size());  // motion of each geom in the world
  for (size_t geom = 0; geom < T_after_before.size(); ++geom) {
    T_after_before[geom] = to.T_world_geom[geom] * from.T_world_geom[geom].inverse();
  }
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const int geom = from.geom.at<int>(v, u);
      if (geom < 0) continue;
      const Vector3d before_world =
          from.T_world_camera * Vector3d(from.depth_m.at<float>(v, u) * ray(from, u, v));
      const Vector3d after_world = T_after_before[static_cast<size_t>(geom)] * before_world;
      if ((after_world - before_world).norm() > kMoves_m) motion.moving.at<uint8_t>(v, u) = 255;
      const Vector3d p_to = T_to_world * after_world;
      if (p_to.z() <= 0) continue;
      const double u_to = to.focal_px * p_to.x() / p_to.z() + to.cx_px;
      const double v_to = to.focal_px * p_to.y() / p_to.z() + to.cy_px;
      motion.flow_px.at<cv::Vec2f>(v, u) = {static_cast<float>(u_to - u), static_cast<float>(v_to - v)};
      if (shows(to, u_to, v_to, p_to.z())) motion.visible.at<uint8_t>(v, u) = 255;
    }
  }
  return motion;
}

double true_overlap(const ImageTruth& from, const ImageTruth& to) {
  const int seen = cv::countNonZero(from.geom >= 0);
  if (seen == 0) return 0;
  return static_cast<double>(cv::countNonZero(image_motion(from, to).visible)) / seen;
}

cv::Mat instances(const ImageTruth& image, const mjModel& model) {
  cv::Mat bodies(image.geom.size(), CV_32SC1);
  std::transform(image.geom.begin<int>(), image.geom.end<int>(), bodies.begin<int>(),
                 [&](int geom) { return geom < 0 ? -1 : model.geom_bodyid[geom]; });
  return bodies;
}

std::vector<slam::OccupancyMap> occupancy_layers(const TruthWorld& truth, const slam::GridGeometry& geometry,
                                                 const std::vector<double>& height_m) {
  std::vector<slam::OccupancyMap> layers;
  for (size_t i = 1; i < height_m.size(); ++i) {
    layers.push_back(truth.occupancy(geometry, height_m[i - 1], height_m[i]));
  }
  return layers;
}

}  // namespace groundloop::sim
