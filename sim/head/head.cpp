#include "sim/head/head.h"

#include <cmath>
#include <filesystem>
#include <numbers>

namespace groundloop::sim {

HeadModel load_head(const std::string& file) {
  HeadModel head;
  std::vector<Problem> problems;
  read_config(load_yaml_file(file), file, head, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return head;
}

slam::StereoRig HeadModel::rig() const {
  const auto turn = [](double angle_deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis);
  };
  // Pan, then tilt, then roll, about the axes of the mount (x forward, y left, z up); up is negative about y.
  const Eigen::Matrix3d R_body_mount =
      (turn(mount.pan_deg, Eigen::Vector3d::UnitZ()) * turn(-mount.tilt_deg, Eigen::Vector3d::UnitY()) *
       turn(mount.roll_deg, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Vector3d p_body(mount.x_m, mount.y_m, mount.z_m);
  slam::StereoRig rig;
  rig.width_px = width_px;
  rig.height_px = height_px;
  rig.fx_px = rig.fy_px = focal_px;
  rig.cx_px = rig.cx_right_px = cx_px;
  rig.cy_px = cy_px;
  rig.baseline_m = baseline_m;
  rig.T_body_left.linear() = R_body_mount * slam::StereoRig::level_camera(p_body).linear();
  rig.T_body_left.translation() = p_body;
  return rig;
}

int64_t HeadModel::period_ns() const { return std::llround(1e9 / rate_hz); }

}  // namespace groundloop::sim
