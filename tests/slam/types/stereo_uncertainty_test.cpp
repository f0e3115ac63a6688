#include "slam/types/stereo_uncertainty.h"

#include <gtest/gtest.h>

namespace groundloop::slam {
namespace {

StereoRig rig_of_head() {
  StereoRig rig;
  rig.fx_px = 576.9, rig.fy_px = 570.1;
  rig.cx_px = 319.5, rig.cy_px = 239.5, rig.cx_right_px = 316.25;
  rig.baseline_m = 0.088;
  return rig;
}

std::vector<Eigen::Vector3d> some_points() {
  return {{0, 0, 1}, {0.5, -0.3, 1.2}, {-1.5, 0.8, 4}, {3.5, 1, 8.5}};
}

TEST(StereoUncertainty, JacobianEqualsFiniteDifferences) {
  const StereoRig rig = rig_of_head();
  constexpr double kStepPx = 1e-4;
  for (const Eigen::Vector3d& p_left : some_points()) {
    const Eigen::Vector3d uvu = rig.project(p_left);
    const Eigen::Matrix3d J = triangulation_jacobian(rig, uvu);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStepPx * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d slope =
          (*rig.triangulate(uvu + step) - *rig.triangulate(uvu - step)) / (2 * kStepPx);
      EXPECT_LT((J.col(i) - slope).norm(), 1e-7 * (1 + slope.norm()))
          << "point " << p_left.transpose() << " input " << i;
    }
  }
}

TEST(StereoUncertainty, JacobianIsTheInverseOfTheProjections) {
  const StereoRig rig = rig_of_head();
  constexpr double kStepM = 1e-6;
  for (const Eigen::Vector3d& p_left : some_points()) {
    Eigen::Matrix3d projection;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStepM * Eigen::Vector3d::Unit(i);
      projection.col(i) = (rig.project(p_left + step) - rig.project(p_left - step)) / (2 * kStepM);
    }
    EXPECT_TRUE((projection * triangulation_jacobian(rig, rig.project(p_left))).isIdentity(1e-6));
  }
}

TEST(StereoUncertainty, DepthNoiseIsThatOfTheDisparity) {
  const StereoRig rig = rig_of_head();
  // sigma_Z = Z^2 sigma_d / (f b), and sigma_d = sigma sqrt(2).
  const Eigen::Matrix3d C = point_covariance(rig, rig.project({0.4, 0.2, 5}), 0.2);
  EXPECT_NEAR(std::sqrt(C(2, 2)), 25 * 0.2 * std::sqrt(2.0) / (rig.fx_px * rig.baseline_m), 1e-12);
}

TEST(StereoUncertainty, OnTheAxisTheThreeDirectionsAreAsCalculatedByHand) {
  StereoRig rig = rig_of_head();
  rig.cx_right_px = rig.cx_px;
  const Eigen::Matrix3d C = point_covariance(rig, rig.project({0, 0, 4}), 0.25);
  // Sideways the left column alone counts; the row is the mean of two; depth goes with both columns.
  EXPECT_NEAR(C(0, 0), std::pow(4 / rig.fx_px * 0.25, 2), 1e-15);
  EXPECT_NEAR(C(1, 1), std::pow(4 / rig.fy_px * 0.25, 2) / 2, 1e-15);
  EXPECT_NEAR(C(1, 2), 0, 1e-15);
  EXPECT_TRUE(C.isApprox(C.transpose(), 1e-15));
}

TEST(StereoUncertainty, AnErrorInOneDirectionOfTheImagesMovesThePointInOne) {
  const StereoRig rig = rig_of_head();
  const Eigen::Vector3d error_px(1, -0.5, 0.8);
  constexpr double kSigma_px = 0.2, kStep = 1e-4;
  for (const Eigen::Vector3d& p_left : some_points()) {
    const Eigen::Vector3d uvu = rig.project(p_left);
    const Eigen::Matrix3d C = point_covariance(rig, uvu, kSigma_px, error_px * error_px.transpose());
    const Eigen::Vector3d moved =
        (*rig.triangulate(uvu + kStep * error_px) - *rig.triangulate(uvu - kStep * error_px)) / (2 * kStep);
    EXPECT_LT((C - kSigma_px * kSigma_px * moved * moved.transpose()).norm(), 1e-6 * C.norm());
  }
}

}  // namespace
}  // namespace groundloop::slam
