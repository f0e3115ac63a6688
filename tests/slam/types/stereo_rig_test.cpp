#include "slam/types/stereo_rig.h"

#include <gtest/gtest.h>

namespace groundloop::slam {
namespace {

StereoRig toed_in_rig() {
  StereoRig rig;
  rig.width_px = 640, rig.height_px = 480;
  rig.fx_px = 500, rig.fy_px = 510;
  rig.cx_px = 319.5, rig.cy_px = 239.5, rig.cx_right_px = 311.5;
  rig.baseline_m = 0.1;
  return rig;
}

TEST(StereoRig, ProjectsByHand) {
  const StereoRig rig = toed_in_rig();
  // At 2 m a metre is 250 columns and 255 rows; the right camera stands 0.1 m, 25 columns, to the right.
  const Eigen::Vector3d uvu = rig.project({0.4, -0.2, 2});
  EXPECT_DOUBLE_EQ(uvu.x(), 319.5 + 100);
  EXPECT_DOUBLE_EQ(uvu.y(), 239.5 - 51);
  EXPECT_DOUBLE_EQ(uvu.z(), 311.5 + 75);
}

TEST(StereoRig, TriangulateUndoesProject) {
  const StereoRig rig = toed_in_rig();
  for (const double z : {0.3, 1.0, 7.5, 90.0}) {
    for (const double x : {-0.7, 0.0, 0.4}) {
      const Eigen::Vector3d p_left(x * z, -0.3 * x * z + 0.05, z);
      const auto found = rig.triangulate(rig.project(p_left));
      ASSERT_TRUE(found);
      EXPECT_LT((*found - p_left).norm(), 1e-11 * z * z) << "z " << z;
    }
  }
}

TEST(StereoRig, DisparityOfInfinityIsTheDifferenceOfPrincipalPoints) {
  const StereoRig rig = toed_in_rig();
  EXPECT_DOUBLE_EQ(rig.disparity_at_infinity_px(), 8);
  const Eigen::Vector3d far = rig.project({0, 0, 1e9});
  EXPECT_NEAR(far.x() - far.z(), 8, 1e-6);
}

TEST(StereoRig, NoPointAtOrBeyondInfinity) {
  const StereoRig rig = toed_in_rig();
  EXPECT_FALSE(rig.triangulate({300, 200, 292}));  // exactly the disparity of infinity
  EXPECT_FALSE(rig.triangulate({300, 200, 293}));  // beyond it
  EXPECT_FALSE(rig.triangulate({300, 200, std::nan("")}));
  EXPECT_TRUE(rig.triangulate({300, 200, 291.9}));
}

TEST(StereoRig, LevelCameraLooksAlongBodyX) {
  const Pose T_body_left = StereoRig::level_camera({0.1, 0, 0.35});
  // One metre ahead, 0.2 right, 0.3 down of the camera.
  const Eigen::Vector3d p_body = T_body_left * Eigen::Vector3d(0.2, 0.3, 1);
  EXPECT_LT((p_body - Eigen::Vector3d(1.1, -0.2, 0.05)).norm(), 1e-15);
  EXPECT_NEAR(T_body_left.linear().determinant(), 1, 1e-15);
}

}  // namespace
}  // namespace groundloop::slam
