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
