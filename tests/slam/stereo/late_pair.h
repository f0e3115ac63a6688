#pragma once

#include <Eigen/LU>
#include <limits>

#include "slam/stereo/right_lag.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {

/// A pair before a slanted wall and a floor, both painted, whose right camera exposes late while the head
/// drives on and turns. What a pair taken together would measure is known exactly.
class LatePair {
 public:
  explicit LatePair(double late_s = 0.05) {
    Vector6d velocity;
    velocity << 0.02, -0.01, 0.3, 0.03, 0.5, -0.02;
    lag = RightLag(velocity, late_s);
    const Eigen::Translation3d right_in_left(rig.baseline_m, 0, 0);
    left = render(Pose::Identity());
    right = render(lag.T_late_left().inverse() * Pose(right_in_left));
    right_in_time = render(Pose(right_in_left));
  }

  /// Disparity that a pair taken together has at a pixel of the left image.
  double disparity_px(double u_px, double v_px) const {
    return rig.fx_px * rig.baseline_m / depth_along(Eigen::Vector3d::Zero(), ray(u_px, v_px));
  }

  const StereoRig rig = centred_rig(480, 320, 420, 0.09);
  RightLag lag;
  cv::Mat left, right, right_in_time;

 private:
  Eigen::Vector3d ray(double u_px, double v_px) const {
    return {(u_px - rig.cx_px) / rig.fx_px, (v_px - rig.cy_px) / rig.fy_px, 1};
  }

  /// How many times `ray` is the way from the eye to what is seen, in the left camera.
  static double depth_along(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) {
    double nearest = std::numeric_limits<double>::max();
    for (const Eigen::Vector4d& surface :
         {Eigen::Vector4d(0.25, 0, 1, 2.2), Eigen::Vector4d(0, 1, 0.05, 0.45)}) {
      const double times = (surface(3) - surface.head<3>().dot(eye)) / surface.head<3>().dot(ray);
      if (times > 0) nearest = std::min(nearest, times);
    }
    return nearest;
  }

  cv::Mat render(const Pose& T_left_camera) const {
    const Eigen::Vector3d eye = T_left_camera.translation();
    return draw({rig.width_px, rig.height_px}, {}, [&](int u, int v) {
      const Eigen::Vector3d along = T_left_camera.linear() * ray(u, v);
      return paint_.at(eye + depth_along(eye, along) * along);
    });
  }

  Texture paint_{11, 0.05, 0.4};
};

}  // namespace groundloop::slam
