#include "sim/head/head.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace groundloop::sim {
namespace {

constexpr int kLargestRender_px = 8192;

}  // namespace

HeadModel load_head(const std::string& file) {
  HeadModel head;
  std::vector<Problem> problems;
  read_config(load_yaml_file(file), file, head, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return head;
}

void HeadModel::check(ConfigReader& reader) const {
  if (!raw) return;
  if (raw->sensor.mosaic != Mosaic::kNone && (width_px % 2 != 0 || height_px % 2 != 0)) {
    reader.problem("raw", "an even width and height behind a colour mosaic");
  }
  try {
    const RenderView view = render_view(raw->optics, read_pixels(raw->sensor, width_px, height_px));
    if (view.size.width > kLargestRender_px || view.size.height > kLargestRender_px) {
      reader.problem("raw", fmt::format("{} x {} rendered pixels", view.size.width, view.size.height),
                     fmt::format("lenses and a supersampling that need at most {} x {}", kLargestRender_px,
                                 kLargestRender_px));
    }
  } catch (const std::domain_error& error) {
    reader.problem("raw", error.what(), "lenses that see one direction at every pixel");
  }
  if (raw->exposure.longest_s() > 1 / rate_hz) {
    reader.problem("raw", fmt::format("{} s for one image", raw->exposure.longest_s()),
                   fmt::format("exposure and read-out within one period, {:.6f} s", 1 / rate_hz));
  }
}

slam::Pose HeadModel::T_left_right() const {
  return sim::T_left_right(baseline_m, raw ? raw->right_pose : RightPose{});
}

std::vector<double> HeadModel::sub_frame_times_s() const {
  return raw ? raw->exposure.sub_frame_times_s() : std::vector<double>{0};
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
  rig.fx_px = raw ? raw->optics.left.fx_px : focal_px;
  rig.fy_px = raw ? raw->optics.left.fy_px : focal_px;
  rig.cx_px = rig.cx_right_px = raw ? raw->optics.left.cx_px : cx_px;
  rig.cy_px = raw ? raw->optics.left.cy_px : cy_px;
  rig.baseline_m = baseline_m;
  rig.T_body_left.linear() = R_body_mount * slam::StereoRig::level_camera(p_body).linear();
  rig.T_body_left.translation() = p_body;
  return rig;
}

int64_t HeadModel::period_ns() const { return std::llround(1e9 / rate_hz); }

}  // namespace groundloop::sim
