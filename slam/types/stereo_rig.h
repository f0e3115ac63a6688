#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/types/pose.h"

namespace groundloop::slam {

/// A rectified stereo pair of pinhole cameras: same rows, same focal length, right camera at +baseline along
/// the left camera's x axis. The centre of the first pixel is (0, 0).
struct StereoRig {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;        ///< principal point of the left image
  double cy_px = 0;        ///< the same row in both images
  double cx_right_px = 0;  ///< principal point of the right image; equals cx_px unless the heads are toed in
  double baseline_m = 0;

  /// Where the left camera sits on the body (x forward, y left, z up, origin on the floor below the axle).
  /// It makes heights above the floor known to the mapper; the default is level, at floor height.
  Pose T_body_left = level_camera(Eigen::Vector3d::Zero());

  /// u_left - u_right of a point at infinity [px].
  double disparity_at_infinity_px() const { return cx_px - cx_right_px; }

  /// Point in the left camera [m] -> (u_left, v, u_right) [px]. Requires z > 0.
  Eigen::Vector3d project(const Eigen::Vector3d& p_left) const {
    const double inverse_z = 1.0 / p_left.z();
    return {fx_px * p_left.x() * inverse_z + cx_px, fy_px * p_left.y() * inverse_z + cy_px,
            fx_px * (p_left.x() - baseline_m) * inverse_z + cx_right_px};
  }

  /// (u_left, v, u_right) [px] -> point in the left camera [m]; none when the point is at or beyond infinity.
  std::optional<Eigen::Vector3d> triangulate(const Eigen::Vector3d& uvu) const {
    const double disparity_px = uvu.x() - uvu.z() - disparity_at_infinity_px();
    if (!(disparity_px > 1e-6)) return std::nullopt;
    const double z = fx_px * baseline_m / disparity_px;
    return Eigen::Vector3d((uvu.x() - cx_px) * z / fx_px, (uvu.y() - cy_px) * z / fy_px, z);
  }

  /// Pose on the body of a camera that looks along the body's x axis, level, at p_body [m].
  static Pose level_camera(const Eigen::Vector3d& p_body) {
    Pose T_body_left = Pose::Identity();
    T_body_left.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // columns: camera x, y, z axes in the body
    T_body_left.translation() = p_body;
    return T_body_left;
  }
};

}  // namespace groundloop::slam
