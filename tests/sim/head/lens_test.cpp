#include "sim/head/lens.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

const Lens kLens{.fx_px = 578,
                 .fy_px = 570,
                 .cx_px = 313,
                 .cy_px = 247,
                 .k1 = -0.18,
                 .k2 = 0.09,
                 .p1 = 0.001,
                 .p2 = -0.0007,
                 .k3 = -0.012};

TEST(Lens, SeesWhatOpenCvProjects) {
  const cv::Matx33d M(578, 0, 313, 0, 570, 247, 0, 0, 1);
  const std::vector<double> D = {-0.18, 0.09, 0.001, -0.0007, -0.012};
  const std::vector<cv::Point3d> points = {{0, 0, 1}, {0.5, -0.4, 1}, {-0.9, 0.8, 1.6}, {0.1, 0.35, 0.7}};
  std::vector<cv::Point2d> uv;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), M, D, uv);
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector2d pixel = kLens.pixel({points[i].x / points[i].z, points[i].y / points[i].z});
    EXPECT_NEAR(pixel.x(), uv[i].x, 1e-10);
    EXPECT_NEAR(pixel.y(), uv[i].y, 1e-10);
  }
}

TEST(Lens, DirectionUndoesPixel) {
  for (double u = -1; u <= 640; u += 64.1) {
    for (double v = -1; v <= 480; v += 48.1) {
      const auto xy = kLens.direction({u, v});
      ASSERT_TRUE(xy) << u << " " << v;
      EXPECT_LT((kLens.pixel(*xy) - Vector2d(u, v)).norm(), 1e-9);
    }
  }
}

TEST(Lens, DerivativeIsThatOfPixel) {
  constexpr double kStep = 1e-6;
  for (const Vector2d& xy : {Vector2d(0, 0), Vector2d(0.4, -0.3), Vector2d(-0.5, 0.35)}) {
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = kStep * Vector2d::Unit(axis);
      const Vector2d numeric = (kLens.pixel(xy + step) - kLens.pixel(xy - step)) / (2 * kStep);
      EXPECT_LT((kLens.derivative(xy).col(axis) - numeric).norm(), 1e-5);
    }
  }
}

TEST(Lens, HasNoDirectionWhereTheDistortionFoldsOver) {
  // r (1 - r^2) is largest at r = 1 / sqrt(3): 0.385; nothing is seen further out
  const Lens strong{.fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0, .k1 = -1};
  EXPECT_TRUE(strong.direction({38, 0}));
  EXPECT_FALSE(strong.direction({39, 0}));
}

}  // namespace
}  // namespace groundloop::sim
