#include "bench/runner/raw_images.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/world/world.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using slam::Pose;

/// A head without noise that sees 320 x 240.
sim::HeadModel quiet_head() {
  sim::HeadModel head;
  head.width_px = 320;
  head.height_px = 240;
  head.baseline_m = 0.1;
  head.raw.emplace();
  sim::RawHead& raw = *head.raw;
  raw.optics.left = raw.optics.right = {.fx_px = 290, .fy_px = 290, .cx_px = 159.5, .cy_px = 119.5};
  raw.optics.vignetting.cosine_power = 0;
  raw.sensor.read_noise_e = raw.sensor.prnu_percent = raw.sensor.dsnu_e = raw.sensor.hot_pixels_ppm = 0;
  // white is 250 grey levels; a full well so deep that shot noise is nothing
  raw.sensor.full_well_e = 1e9;
  raw.sensor.white_photons_per_s = 1e9;
  raw.exposure.time_s = 0.01;
  raw.sensor.gain_dn_per_e = 250 / (1e9 * 0.5 * 0.01);
  return head;
}

/// A camera at the origin that looks along x, turned to the left by an angle.
Pose camera_turned(double yaw_rad) {
  Pose T = slam::StereoRig::level_camera(Vector3d::Zero());
  T.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * T.linear();
  return T;
}

class RawImagesOf : public testing::Test {
 protected:
  /// Bodies seen from the origin, and an exposure of them that stands still.
  void see(const std::string& bodies) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("groundloop_raw_{}.xml", getpid());
    std::ofstream(file) << "<mujoco><statistic extent='5'/><asset>"
                           "<material name='bright' emission='1' rgba='1 1 1 1'/></asset><worldbody>"
                        << bodies << "</worldbody></mujoco>";
    world_.emplace(sim::World::load_file(file.string()));
    std::filesystem::remove(file);
    std::shared_ptr<mjData> state(world_->make_data().release(), mj_deleteData);
    mj_kinematics(&world_->model(), state.get());
    exposure_.state = exposure_.state_right = state;
    exposure_.T_world_left = camera_turned(0);
    exposure_.T_world_right = exposure_.T_world_left * head_.T_left_right();
  }

  /// Both cameras turn steadily to the left while they expose.
  void turn(double rate_radps) {
    for (const double t_s : head_.sub_frame_times_s()) {
      const Pose T_world_left = camera_turned(rate_radps * t_s);
      exposure_.left_sub_frames.push_back({exposure_.state, {}, T_world_left});
      exposure_.right_sub_frames.push_back({exposure_.state, {}, T_world_left * head_.T_left_right()});
    }
  }

  /// Raw left and right image.
  std::array<cv::Mat, 2> taken(const RawImages& images) {
    sim::Renderer renderer(*world_, images.view().size.width, images.view().size.height,
                           {.reflections = false});
    std::array<cv::Mat, 2> raw;
    const sim::ExposureSetting setting{head_.raw->exposure.time_s, head_.raw->exposure.gain_db};
    images.read_out(images.light(exposure_, renderer), 0, setting, raw[0], raw[1]);
    return raw;
  }

  sim::HeadModel head_ = quiet_head();
  sim::Scenario scenario_;
  std::optional<sim::World> world_;
  sim::Exposure exposure_;
};

/// Centre and variance of a bright stripe along one row.
struct Stripe {
  double centre_px, variance_px2;
};
Stripe stripe_in(const cv::Mat& image, int row) {
  double sum = 0, first = 0, second = 0;
  for (int u = 0; u < image.cols; ++u) {
    const double grey = image.at<uchar>(row, u);
    sum += grey, first += grey * u, second += grey * u * u;
  }
  return {first / sum, second / sum - first / sum * first / sum};
}

constexpr const char* kStripe = "<geom type='box' size='0.01 0.06 5' material='bright' pos='4 0 0'/>";

/// A turn to the left moves what is ahead to the right, a row the later the lower it is.
TEST_F(RawImagesOf, ARollingShutterSlantsAStripe) {
  head_.raw->exposure.readout_s = 0.03;
  head_.raw->exposure.time_s = 0.002;
  head_.raw->sensor.gain_dn_per_e *= 5;
  head_.raw->exposure.sub_frames = 16;
  see(kStripe);
  const double rate_radps = 0.8;
  turn(rate_radps);
  const cv::Mat left = taken(RawImages(head_, scenario_))[0];
  const double step_px = rate_radps * 290 * 0.032 / 16;
  for (const int row : {0, 60, 120, 180, 239}) {
    const double t_s = 0.03 * ((row + 0.5) / 240 - 0.5);
    const double expected_px = 159.5 + 290 * std::tan(rate_radps * t_s);
    EXPECT_NEAR(stripe_in(left, row).centre_px, expected_px, 0.5 * step_px + 0.05) << row;
  }
  EXPECT_GT(stripe_in(left, 239).centre_px - stripe_in(left, 0).centre_px, 6);
}

TEST_F(RawImagesOf, MotionWidensAStripeByItsWay) {
  head_.raw->exposure.sub_frames = 8;
  see(kStripe);
  turn(2.0);
  const Stripe moved = stripe_in(taken(RawImages(head_, scenario_))[0], 120);
  // the stripe, a pixel, and eight places evenly over the way
  const double width_px = 290 * 0.12 / 3.99, part_px = 2.0 * 290 * 0.01 / 8;
  EXPECT_NEAR(moved.variance_px2, (width_px * width_px + 1 + part_px * part_px * (8 * 8 - 1)) / 12, 0.08);
  EXPECT_NEAR(moved.centre_px, 159.5, 0.05) << "the stamp is the middle of the exposure";
}

/// From the scene to the rectified pair: a disc comes to lie where the rig says that the point is.
TEST_F(RawImagesOf, TheTruthIsThatOfTheRectifiedLeftCamera) {
  sim::Optics& optics = head_.raw->optics;
  optics.left = {.fx_px = 288,
                 .fy_px = 291,
                 .cx_px = 152,
                 .cy_px = 126,
                 .k1 = -0.2,
                 .k2 = 0.08,
                 .p1 = 0.001,
                 .p2 = -0.002};
  optics.right = {.fx_px = 293,
                  .fy_px = 289,
                  .cx_px = 166,
                  .cy_px = 113,
                  .k1 = -0.18,
                  .k2 = 0.06,
                  .p1 = -0.001,
                  .p2 = 0.001};
  head_.raw->right_pose = {
      .down_m = 0.002, .forward_m = -0.003, .pan_deg = 1.5, .tilt_deg = -1, .roll_deg = 2};
  for (const Vector3d& p_world :
       {Vector3d(2, 0.1, 0.05), Vector3d(2.5, -0.9, -0.6), Vector3d(2.2, 0.7, 0.6)}) {
    see(fmt::format("<geom type='sphere' size='0.02' material='bright' pos='{} {} {}'/>", p_world.x(),
                    p_world.y(), p_world.z()));
    const RawImages images(head_, scenario_);
    EXPECT_GT(Eigen::AngleAxisd(images.rectifier().T_raw_left().linear()).angle(), 0.005);
    const std::array<cv::Mat, 2> raw = taken(images);
    slam::StereoFrame frame;
    images.transfer(raw[0], raw[1], false, frame);
    const Pose T_world_left = exposure_.T_world_left * images.rectifier().T_raw_left();
    const Vector3d uvu = images.rectifier().rig().project(T_world_left.inverse() * p_world);
    const cv::Moments left = cv::moments(frame.left), right = cv::moments(frame.right);
    // cv::remap's maps have steps of 1/32 px
    EXPECT_NEAR(left.m10 / left.m00, uvu.x(), 0.06) << p_world.transpose();
    EXPECT_NEAR(left.m01 / left.m00, uvu.y(), 0.06) << p_world.transpose();
    EXPECT_NEAR(right.m10 / right.m00, uvu.z(), 0.06) << p_world.transpose();
    EXPECT_NEAR(right.m01 / right.m00, uvu.y(), 0.06) << p_world.transpose();
  }
}

TEST_F(RawImagesOf, ExposuresThatArriveAgainHaveTheSettingTheyHad) {
  head_.raw->exposure.automatic =
      sim::AutoExposureModel{.target_grey = 100, .lag_frames = 1, .speed = 1, .max_time_s = 0.05};
  RawImages images(head_, scenario_);
  const cv::Mat dark(240, 320, CV_8UC1, cv::Scalar(50));
  EXPECT_DOUBLE_EQ(images.setting(0).time_s, 0.01);
  images.observe(dark);
  EXPECT_DOUBLE_EQ(images.setting(0).time_s, 0.01);
  images.observe(dark);
  EXPECT_NEAR(images.setting(2).time_s, 0.02, 1e-12) << "exposure 1 was lost";
}

/// Light, exposure faults and gain: what a fault doubles, the image doubles, up to the full range.
TEST_F(RawImagesOf, LightFaultsActBeforeTheSensor) {
  see("<geom type='box' size='0.01 9 9' material='bright' pos='4 0 0'/>");
  head_.raw->sensor.gain_dn_per_e *= 0.2;  // white is 50
  sim::Fault fault;
  fault.at_s = 0;
  fault.exposure = sim::ExposureFault{.factor = 3};
  EXPECT_NEAR(cv::mean(taken(RawImages(head_, scenario_))[0])[0], 50, 0.6);
  scenario_.faults = {fault};
  EXPECT_NEAR(cv::mean(taken(RawImages(head_, scenario_))[0])[0], 150, 1) << "beyond white";
}

}  // namespace
}  // namespace groundloop::bench
