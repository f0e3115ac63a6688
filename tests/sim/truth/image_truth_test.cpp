#include "sim/truth/image_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "slam/types/stereo_rig.h"
#include "tests/sim/truth/scene.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;

const cv::Size kSize(80, 60);

/// A camera that looks along x from (0, 0, 1), 100 px of focal length.
ImageTruth view_at(const Vector3d& p_world, double yaw_rad = 0) {
  ImageTruth view;
  view.focal_px = 100;
  view.cx_px = 41.25;  // off the centre, so that a wrong principal point shows
  view.cy_px = 27.5;
  view.T_world_camera = slam::StereoRig::level_camera(p_world);
  view.T_world_camera.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * view.T_world_camera.linear();
  return view;
}

/// A wall 4 m ahead with a box in front of it, on a floor. The box may stand elsewhere, turned.
struct Room {
  explicit Room(const std::string& box = "pos='2 0 1'")
      : scene(
            "<geom name='floor' type='plane' size='20 20 1'/><geom name='wall' type='box' size='.5 9 9' "
            "pos='4.5 0 0'/>"
            "<body name='crate' " +
            box + "><geom name='box' type='box' size='.2 .2 .2'/></body>"),
        truth(*scene.model, *scene.data, -1) {}

  ImageTruth see(ImageTruth view) const {
    view.T_world_geom = geom_poses(*scene.model, *scene.data);
    cast_image_truth(truth, kSize, view);
    return view;
  }

  Scene scene;
  TruthWorld truth;
};

TEST(ImageTruth, DepthAndGeomsOfPlanesAndABox) {
  const Room room;
  const ImageTruth left = room.see(view_at({0, 0, 1}));
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double x = (u - 41.25) / 100, y = (v - 27.5) / 100;
      const bool box = std::abs(x) * 1.8 < 0.2 && std::abs(y) * 1.8 < 0.2;
      const bool floor = !box && y * 4 > 1;
      const double depth_m = box ? 1.8 : floor ? 1 / y : 4;
      ASSERT_NEAR(left.depth_m.at<float>(v, u), depth_m, 1e-5 * depth_m) << u << " " << v;
      ASSERT_EQ(left.geom.at<int>(v, u), room.scene.geom(box ? "box" : floor ? "floor" : "wall"));
    }
  }
}

TEST(ImageTruth, NothingIsInfinitelyFarAndHasNoDisparity) {
  const Scene scene("<geom type='box' size='.1 .1 .1' pos='-3 0 0'/>");
  const TruthWorld truth(*scene.model, *scene.data, -1);
  ImageTruth view = view_at({0, 0, 1});
  view.T_world_geom = geom_poses(*scene.model, *scene.data);
  cast_image_truth(truth, kSize, view);
  EXPECT_TRUE(std::isinf(view.depth_m.at<float>(30, 30)));
  EXPECT_EQ(view.geom.at<int>(30, 30), -1);
  EXPECT_EQ(true_disparity_px(view, 0.1).at<float>(30, 30), 0);
  const ImageMotion motion = image_motion(view, view);
  EXPECT_TRUE(std::isnan(motion.flow_px.at<cv::Vec2f>(30, 30)[0]));
  EXPECT_EQ(cv::countNonZero(motion.visible), 0);
  EXPECT_EQ(true_overlap(view, view), 0);
}

TEST(ImageTruth, DisparityIsTheFlowToTheRightCamera) {
  const Room room;
  const double baseline_m = 0.1;
  const ImageTruth left = room.see(view_at({0, 0, 1}));
  const ImageTruth right = room.see(view_at({0, -baseline_m, 1}));
  const cv::Mat disparity_px = true_disparity_px(left, baseline_m);
  const ImageMotion motion = image_motion(left, right);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const cv::Vec2f flow = motion.flow_px.at<cv::Vec2f>(v, u);
      ASSERT_NEAR(flow[0], -disparity_px.at<float>(v, u), 1e-4);
      ASSERT_NEAR(flow[1], 0, 1e-4);
    }
  }
  EXPECT_NEAR(disparity_px.at<float>(28, 41), 100 * baseline_m / 1.8, 1e-4);
  EXPECT_NEAR(disparity_px.at<float>(5, 5), 100 * baseline_m / 4, 1e-4);
  EXPECT_EQ(cv::countNonZero(motion.moving), 0);
}

// In the left image the box covers u - 41.25 in +-11.1; from 0.1 m to the right it has moved 5.6 px to the
// left, the wall 2.5.
TEST(ImageTruth, WhatTheBoxHidesFromTheRightCameraIsNotVisible) {
  const Room room;
  const ImageMotion motion = image_motion(room.see(view_at({0, 0, 1})), room.see(view_at({0, -0.1, 1})));
  const int row = 28;
  // Wall right behind the box's left edge: hidden from u - 41.25 in (-11.1 - 3.05, -11.1).
  for (const int u : {28, 29}) EXPECT_EQ(motion.visible.at<uint8_t>(row, u), 0) << u;
  for (const int u : {5, 20, 25, 32, 41, 51, 54, 60, 78})
    EXPECT_EQ(motion.visible.at<uint8_t>(row, u), 255) << u;
  EXPECT_EQ(motion.visible.at<uint8_t>(row, 0), 0);  // at u = -2.5 of the right image
}

TEST(ImageTruth, AMovedBoxFlowsWithItsMotion) {
  const Room before, after("pos='2.1 .15 1' euler='0 0 10'");
  const ImageTruth from = before.see(view_at({0, 0, 1}));
  const ImageTruth to = after.see(view_at({0.05, 0.02, 1.01}, 0.03));
  const ImageMotion motion = image_motion(from, to);
  const double turn_rad = 10 * std::numbers::pi / 180;
  int on_box = 0;
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const bool box = from.geom.at<int>(v, u) == before.scene.geom("box");
      ASSERT_EQ(motion.moving.at<uint8_t>(v, u), box ? 255 : 0);
      // the pixel's point in the world, written out by hand
      const double z = from.depth_m.at<float>(v, u);
      Vector3d p(z, -(u - 41.25) / 100 * z, 1 - (v - 27.5) / 100 * z);
      if (box) {
        const Vector3d in_box = p - Vector3d(2, 0, 1);
        p = Vector3d(2.1, 0.15, 1) + Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()) * in_box;
        ++on_box;
      }
      const Vector3d seen =
          Eigen::AngleAxisd(-0.03, Vector3d::UnitZ()) * Vector3d(p - Vector3d(0.05, 0.02, 1.01));
      const cv::Vec2f flow = motion.flow_px.at<cv::Vec2f>(v, u);
      ASSERT_NEAR(flow[0], 41.25 - 100 * seen.y() / seen.x() - u, 1e-3);
      ASSERT_NEAR(flow[1], 27.5 - 100 * seen.z() / seen.x() - v, 1e-3);
    }
  }
  EXPECT_GT(on_box, 300);
}

TEST(ImageTruth, OverlapOfTurnedViews) {
  const Scene scene("<geom type='box' size='.5 90 90' pos='10.5 0 0'/>");
  const TruthWorld truth(*scene.model, *scene.data, -1);
  const auto see = [&](double yaw_rad) {
    ImageTruth view = view_at({0, 0, 0}, yaw_rad);
    view.T_world_geom = geom_poses(*scene.model, *scene.data);
    cast_image_truth(truth, kSize, view);
    return view;
  };
  const ImageTruth ahead = see(0);
  EXPECT_EQ(true_overlap(ahead, ahead), 1);
  EXPECT_EQ(true_overlap(ahead, see(std::numbers::pi / 2)), 0);
  // a turn by which the column of the principal point becomes the image's left edge: u > 41.25 of 80 stays
  EXPECT_NEAR(true_overlap(ahead, see(-std::atan2(41.75, 100.0))), (80 - 41.25) / 80, 0.06);
}

TEST(ImageTruth, InstancesAreBodies) {
  const Room room;
  const ImageTruth left = room.see(view_at({0, 0, 1}));
  const cv::Mat bodies = instances(left, *room.scene.model);
  EXPECT_EQ(bodies.at<int>(28, 41), room.scene.body("crate"));
  EXPECT_EQ(bodies.at<int>(5, 5), 0);
}

TEST(ImageTruth, LayersHoldWhatReachesIntoThem) {
  const Room room;  // box from z = 0.8 to 1.2, wall from 0 to 9
  const slam::GridGeometry grid = room.truth.bounds(0.1);
  const std::vector<slam::OccupancyMap> layers = occupancy_layers(room.truth, grid, {0.02, 0.7, 0.9, 1.3, 2});
  ASSERT_EQ(layers.size(), 4U);
  const auto at = [&](size_t layer, double x_m, double y_m) {
    const int col = static_cast<int>((x_m - grid.x_min_m) / grid.cell_m);
    const int row = static_cast<int>((y_m - grid.y_min_m) / grid.cell_m);
    return layers[layer].value[static_cast<size_t>(row * grid.cols + col)];
  };
  const float box[] = {0, 1, 1, 0};
  for (size_t layer = 0; layer < 4; ++layer) {
    EXPECT_EQ(at(layer, 2.05, 0.05), box[layer]) << layer;
    EXPECT_EQ(at(layer, 4.45, 0.05), 1) << layer;
    EXPECT_EQ(at(layer, 1.05, 0.05), 0) << layer;
  }
}

}  // namespace
}  // namespace groundloop::sim
