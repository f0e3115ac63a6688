// Against the homography of a plane between two views, written down on its own.
#include "slam/tracking/perspective.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

StereoRig rig_of_test() { return centred_rig(640, 480, 500, 0.1); }

/// A plane normal . p = distance in the left camera of the first view.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d(0.7, 0.2, 1).normalized();
  double distance_m = 3;

  Eigen::Vector3d point(const StereoRig& rig, const Eigen::Vector2d& uv_px) const {
    const Eigen::Vector3d ray((uv_px.x() - rig.cx_px) / rig.fx_px, (uv_px.y() - rig.cy_px) / rig.fy_px, 1);
    return distance_m / normal.dot(ray) * ray;
  }
};

const Eigen::Vector2d kFirst_px(400, 300);

TEST(Perspective, TheSlopeOfAPlaneIsThatOfItsDisparity) {
  const StereoRig rig = rig_of_test();
  const Plane plane;
  const auto depth_m = [&](double u, double v) { return plane.point(rig, {u, v}).z(); };
  const auto disparity_px = [&](double u, double v) { return rig.fx_px * rig.baseline_m / depth_m(u, v); };
  const double d = disparity_px(kFirst_px.x(), kFirst_px.y()), h = 1;
  AffineState left, right;  // the right window is as much narrower as the disparity grows
  right.A(0, 0) -= static_cast<float>((disparity_px(kFirst_px.x() + h, kFirst_px.y()) - d) / h);
  right.A(0, 1) -= static_cast<float>((disparity_px(kFirst_px.x(), kFirst_px.y() + h) - d) / h);
  const Eigen::Vector2f slope = inverse_depth_slope(left, right, d);
  const double z = depth_m(kFirst_px.x(), kFirst_px.y());
  EXPECT_NEAR(slope.x(), (z / depth_m(kFirst_px.x() + h, kFirst_px.y()) - 1) / h, 1e-6);
  EXPECT_NEAR(slope.y(), (z / depth_m(kFirst_px.x(), kFirst_px.y() + h) - 1) / h, 1e-6);
}

TEST(Perspective, IsThatOfThePlanesHomography) {
  const StereoRig rig = rig_of_test();
  const Plane plane;
  Vector6d twist;
  twist << 0.2, -0.1, 0.8, 0.05, -0.2, 0.1;
  const Pose T_left_first = se3_exp(twist);
  const Eigen::Vector3d p_first = plane.point(rig, kFirst_px), p_left = T_left_first * p_first;
  const Eigen::Vector2d slope((p_first.z() / plane.point(rig, kFirst_px + Eigen::Vector2d(1, 0)).z() - 1),
                              (p_first.z() / plane.point(rig, kFirst_px + Eigen::Vector2d(0, 1)).z() - 1));
  const Eigen::Vector2d c = perspective_per_px(rig, T_left_first, p_left, slope.cast<float>()).cast<double>();
  ASSERT_GT(c.norm(), 1e-4);

  const auto now_px = [&](const Eigen::Vector2d& x) -> Eigen::Vector2d {
    return rig.project(T_left_first * plane.point(rig, kFirst_px + x)).head<2>();
  };
  // y (1 + c x) = A x for every x: with A from small x, the rest must follow.
  const double h = 1e-4;
  Eigen::Matrix2d A;
  for (int k = 0; k < 2; ++k)
    A.col(k) = (now_px(h * Eigen::Vector2d::Unit(k)) - now_px(-h * Eigen::Vector2d::Unit(k))) / (2 * h);
  for (const Eigen::Vector2d& x :
       {Eigen::Vector2d(20, 0), Eigen::Vector2d(0, -30), Eigen::Vector2d(-25, 15)}) {
    const Eigen::Vector2d y = now_px(x) - now_px({0, 0});
    EXPECT_LT((y * (1 + c.dot(x)) - A * x).norm(), 1e-4 * x.norm()) << x.transpose();
  }
}

}  // namespace
}  // namespace groundloop::slam
