#include "sim/head/head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace groundloop::sim {
namespace {

TEST(Head, DeliveredModelsLoad) {
  const HeadModel head = load_head("models/heads/sth_mdcs.yaml");
  EXPECT_EQ(head.width_px, 640);
  EXPECT_EQ(head.height_px, 480);
  EXPECT_DOUBLE_EQ(head.baseline_m, 0.088);
  EXPECT_NEAR(head.focal_px, 6 / 0.0104, 0.01);
  EXPECT_EQ(head.period_ns(), 133333333);
  EXPECT_NEAR(load_head("models/heads/sth_mdcs_4_8mm.yaml").focal_px, 4.8 / 0.0104, 0.01);
}

TEST(Head, LevelRigLooksAlongBodyX) {
  HeadModel head;
  head.mount = {.x_m = 0.08, .y_m = 0.044, .z_m = 0.35};
  const slam::StereoRig rig = head.rig();
  // A point 2 m ahead, 0.1 m left of and 0.2 m above the left camera, in the body.
  const Eigen::Vector3d p_left = rig.T_body_left.inverse() * Eigen::Vector3d(2.08, 0.144, 0.55);
  EXPECT_TRUE(p_left.isApprox(Eigen::Vector3d(-0.1, -0.2, 2.0), 1e-12)) << p_left.transpose();
  // The right camera is the baseline to the right, so symmetric to the robot's middle.
  const Eigen::Vector3d p_right_body = rig.T_body_left * Eigen::Vector3d(rig.baseline_m, 0, 0);
  EXPECT_NEAR(p_right_body.y(), -0.044, 1e-12);
}

TEST(Head, PanTurnsLeftAndTiltUp) {
  HeadModel head;
  head.mount = {.pan_deg = 90};
  EXPECT_TRUE(head.rig().T_body_left.linear().col(2).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  head.mount = {.tilt_deg = 30};
  EXPECT_NEAR(head.rig().T_body_left.linear()(2, 2), 0.5, 1e-12);
  head.mount = {.roll_deg = 10};  // about the optical axis: the view direction stays
  EXPECT_TRUE(head.rig().T_body_left.linear().col(2).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

/// Problems of a head file's text.
std::vector<std::string> problems_of(const std::string& text) {
  const std::string file = (std::filesystem::temp_directory_path() / "groundloop_raw_head.yaml").string();
  std::ofstream(file) << text;
  std::vector<std::string> lines;
  try {
    load_head(file);
  } catch (const InputError& error) {
    for (Problem problem : error.problems()) {
      problem.file = "head.yaml";
      lines.push_back(problem.text());
    }
  }
  std::filesystem::remove(file);
  return lines;
}

TEST(Head, ARawHeadIsWrittenAndReadAgain) {
  const HeadModel head = load_head("models/heads/sth_mdcs_raw.yaml");
  ASSERT_TRUE(head.raw);
  EXPECT_EQ(head.raw->sensor.reduction, Reduction::kDecimation);
  EXPECT_EQ(problems_of(to_yaml(head)), std::vector<std::string>{});
}

TEST(Head, ARawHeadHasNoIdealOne) {
  using testing::ElementsAre;
  EXPECT_THAT(problems_of("name: a\nfocal_px: 500\nraw: {}\n"),
              ElementsAre(testing::StartsWith("head.yaml:2: focal_px: unknown key")));
  EXPECT_THAT(problems_of("name: a\nrate_hz: 30\nraw: {exposure: {time_s: 0.02, readout_s: 0.02}}\n"),
              ElementsAre(testing::HasSubstr(
                  "0.04 s for one image: wanted exposure and read-out within one period")));
  EXPECT_THAT(problems_of("name: a\nraw: {optics: {left: {k1: -2}}}\n"),
              ElementsAre(testing::HasSubstr("a distortion that folds over inside the image")));
  EXPECT_THAT(problems_of("name: a\nwidth_px: 321\nraw: {sensor: {mosaic: rggb}}\n"),
              ElementsAre(testing::HasSubstr("wanted an even width and height behind a colour mosaic")));
  EXPECT_THAT(
      problems_of("name: a\nraw: {optics: {supersampling: 4, left: {fx_px: 20000}}}\n"),
      ElementsAre(testing::HasSubstr("wanted lenses and a supersampling that need at most 8192 x 8192")));
  EXPECT_THAT(problems_of("name: a\nraw: {exposure: {auto: {min_time_s: 0.02, max_time_s: 0.01}}}\n"),
              ElementsAre(testing::HasSubstr("min_time_s: 0.02: wanted a time not above max_time_s")));
}

TEST(Head, TheRightCameraSitsWhereItIsSaidTo) {
  HeadModel head;
  head.raw.emplace();
  head.raw->right_pose = {.down_m = 0.002, .forward_m = 0.003, .pan_deg = 2};
  const slam::Pose T = head.T_left_right();
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(0.088, 0.002, 0.003), 1e-12));
  EXPECT_NEAR(T.linear()(0, 2), -std::sin(2 * M_PI / 180), 1e-12) << "it looks to the left";
  head.raw->right_pose = {.tilt_deg = 3};
  EXPECT_NEAR(head.T_left_right().linear()(1, 2), -std::sin(3 * M_PI / 180), 1e-12) << "up";
  head.raw->right_pose = {.roll_deg = 4};
  EXPECT_NEAR(head.T_left_right().linear()(1, 0), std::sin(4 * M_PI / 180), 1e-12)
      << "its right side is down";
}

TEST(Head, BadFileNamesEveryProblem) {
  const std::string file = (std::filesystem::temp_directory_path() / "groundloop_bad_head.yaml").string();
  std::ofstream(file) << "name: bad\nbaseline_m: -1\nfocal: 500\n";
  try {
    load_head(file);
    FAIL() << "a negative baseline and an unknown key passed";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("groundloop_bad_head.yaml:2: baseline_m: -1"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("groundloop_bad_head.yaml:3: focal"));
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace groundloop::sim
