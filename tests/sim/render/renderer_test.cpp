#include "sim/render/renderer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>
#include <thread>

#include "slam/types/stereo_rig.h"

namespace groundloop::sim {
namespace {

constexpr int kWidth_px = 640, kHeight_px = 480;

World world_of(const std::string& body) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("groundloop_render_{}.xml", getpid());
  std::ofstream(file) << "<mujoco><asset><material name='bright' emission='1' rgba='1 1 1 1'/>"
                         "<material name='mirror' rgba='.4 .4 .4 1' reflectance='0.5'/></asset><worldbody>"
                      << body << "</worldbody></mujoco>";
  World world = World::load_file(file.string());
  std::filesystem::remove(file);
  return world;
}

RenderSettings choice(int antialiasing, bool reflections = false, bool shadows = false) {
  return {.antialiasing = antialiasing, .reflections = reflections, .shadows = shadows};
}

Renderer::Camera camera_at(const Eigen::Vector3d& p_world, double yaw_deg = 0, double focal_px = 500) {
  const Eigen::AngleAxisd turn(yaw_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ());
  Renderer::Camera camera{focal_px, 0.5 * (kWidth_px - 1), 0.5 * (kHeight_px - 1), slam::Pose::Identity()};
  camera.T_world_camera.linear() = turn * slam::StereoRig::level_camera({0, 0, 0}).linear();
  camera.T_world_camera.translation() = p_world;
  return camera;
}

cv::Mat grey_of(const World& world, const Renderer::Camera& camera, const RenderSettings& how) {
  Renderer renderer(world, kWidth_px, kHeight_px, how);
  renderer.update_scene(*world.make_data());
  cv::Mat grey;
  renderer.render_grey(camera, grey);
  return grey;
}

/// A bright disc of 6 cm radius that faces a camera looking along yaw.
std::string disc(const Eigen::Vector3d& p_world, double yaw_deg) {
  const double yaw_rad = yaw_deg * std::numbers::pi / 180;
  return fmt::format(
      "<geom type='cylinder' size='0.06 1e-6' material='bright' pos='{} {} {}' zaxis='{} {} 0'/>",
      p_world.x(), p_world.y(), p_world.z(), std::cos(yaw_rad), std::sin(yaw_rad));
}

/// Grey-weighted centre of what is brighter than the black background.
Eigen::Vector2d centroid(const cv::Mat& grey) {
  double sum = 0, u = 0, v = 0;
  for (int row = 0; row < grey.rows; ++row) {
    for (int col = 0; col < grey.cols; ++col) {
      sum += grey.at<uchar>(row, col);
      u += col * grey.at<uchar>(row, col);
      v += row * grey.at<uchar>(row, col);
    }
  }
  EXPECT_GT(sum, 1000);
  return {u / sum, v / sum};
}

struct Intrinsics {
  double focal_px, cx_px, cy_px;
};

class RendererIntrinsics : public ::testing::TestWithParam<Intrinsics> {};

// A disc parallel to the image plane: its centroid projects to the centroid of its image.
TEST_P(RendererIntrinsics, PointsFallWhereThePinholeSays) {
  const auto [focal_px, cx_px, cy_px] = GetParam();
  const double yaw_deg = 35;
  Renderer::Camera camera = camera_at({1.5, -2.2, 0.35}, yaw_deg, focal_px);
  camera.cx_px = cx_px;
  camera.cy_px = cy_px;
  for (const Eigen::Vector2d& uv :
       {Eigen::Vector2d(319.5, 239.5), {60.3, 50.8}, {600.2, 400.6}, {100.7, 440.1}}) {
    const double z_m = 3;
    const Eigen::Vector3d p_camera((uv.x() - cx_px) * z_m / focal_px, (uv.y() - cy_px) * z_m / focal_px, z_m);
    const World world = world_of(disc(camera.T_world_camera * p_camera, yaw_deg));
    const Eigen::Vector2d seen = centroid(grey_of(world, camera, choice(4)));
    EXPECT_NEAR(seen.x(), uv.x(), 0.1);
    EXPECT_NEAR(seen.y(), uv.y(), 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, RendererIntrinsics,
                         ::testing::Values(Intrinsics{576.92, 319.5, 239.5},
                                           Intrinsics{461.54, 300.25, 260.75}, Intrinsics{700, 390, 180.5}));

TEST(Renderer, DisparityIsFocalLengthTimesBaselineOverDepth) {
  const double baseline_m = 0.088;
  for (const double z_m : {1.0, 2.5, 6.0}) {
    const World world = world_of(disc({z_m, 0.1, 0.4}, 0));
    const Eigen::Vector2d left = centroid(grey_of(world, camera_at({0, 0.044, 0.35}), choice(4)));
    const Eigen::Vector2d right =
        centroid(grey_of(world, camera_at({0, 0.044 - baseline_m, 0.35}), choice(4)));
    EXPECT_NEAR(left.x() - right.x(), 500 * baseline_m / z_m, 0.1) << z_m;
    EXPECT_NEAR(left.y(), right.y(), 0.1) << z_m;
  }
}

TEST(Renderer, DepthOfWallFloorAndNothing) {
  const double height_m = 0.35;
  const World world =
      world_of("<geom type='plane' size='20 20 1'/><geom type='box' size='0.5 1 1' pos='5.5 0 0'/>");
  Renderer renderer(world, kWidth_px, kHeight_px, choice(0));
  renderer.update_scene(*world.make_data());
  const Renderer::Camera camera = camera_at({0, 0, height_m});
  cv::Mat depth_m;
  renderer.render_depth(camera, depth_m);
  ASSERT_EQ(depth_m.type(), CV_32FC1);
  EXPECT_NEAR(depth_m.at<float>(240, 320), 5.0, 2e-4);  // the box's front, 5 m ahead
  EXPECT_NEAR(depth_m.at<float>(200, 380), 5.0, 2e-4);  // the same depth everywhere on it
  for (const int row : {300, 360, 479}) {
    const double floor_m = height_m * camera.focal_px / (row - camera.cy_px);
    EXPECT_NEAR(depth_m.at<float>(row, 100), floor_m, 1e-4 * floor_m) << row;
  }
  EXPECT_NEAR(depth_m.at<float>(10, 320), 60, 0.1);  // nothing there: the far plane
}

TEST(Renderer, DepthNeedsSingleSamples) {
  const World world = world_of("<geom size='1'/>");
  Renderer renderer(world, 64, 48, choice(4));
  renderer.update_scene(*world.make_data());
  cv::Mat depth_m;
  EXPECT_THROW(renderer.render_depth(camera_at({0, 0, 3}), depth_m), std::logic_error);
}

TEST(Renderer, SaysWhatItIs) {
  const World world = world_of("<geom size='1'/>");
  for (const int samples : {0, 2, 4}) {
    const RendererInfo info = Renderer(world, 64, 48, choice(samples)).info();
    EXPECT_EQ(info, renderer_info(choice(samples)));  // known without making a renderer
    EXPECT_EQ(info.backend, "OSMesa");
    EXPECT_THAT(info.renderer, ::testing::HasSubstr("llvmpipe"));
    EXPECT_THAT(info.version, ::testing::HasSubstr("Mesa"));
    EXPECT_EQ(info.samples, samples == 2 ? info.samples : samples);
    EXPECT_GE(info.samples, samples);
  }
}

TEST(Renderer, ColoursAndGreyWeights) {
  const World world =
      world_of("<geom type='box' size='1e-3 1 1' pos='2 0 0' rgba='1 0 0 1' material='bright'/>");
  Renderer renderer(world, 64, 48, choice(0));
  renderer.update_scene(*world.make_data());
  cv::Mat bgr, grey;
  Renderer::Camera camera = camera_at({0, 0, 0});
  camera.focal_px = 50;
  camera.cx_px = 31.5;
  camera.cy_px = 23.5;
  renderer.render_bgr(camera, bgr);
  renderer.render_grey(camera, grey);
  EXPECT_EQ(bgr.at<cv::Vec3b>(24, 32), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(grey.at<uchar>(24, 32), 77);  // 0.299 * 255 = 76.2 with weights in 256ths
}

TEST(Renderer, TopOfTheWorldIsTopOfTheImage) {
  const World world = world_of(disc({3, 0, 1}, 0));
  EXPECT_LT(centroid(grey_of(world, camera_at({0, 0, 0}), choice(0))).y(), 120);
  const World leftward = world_of(disc({3, 1, 0}, 0));
  EXPECT_LT(centroid(grey_of(leftward, camera_at({0, 0, 0}), choice(0))).x(), 200);
}

TEST(Renderer, GroupThreeIsForCollisionsOnly) {
  const auto seen = [](int group) {
    const World world =
        world_of(fmt::format("<geom type='box' size='0.1 1 1' pos='3 0 0' material='bright' "
                             "group='{}'/><site pos='2 0 0' size='1'/>",
                             group));
    return cv::countNonZero(grey_of(world, camera_at({0, 0, 0}), choice(0)));
  };
  EXPECT_GT(seen(0), 1000);
  EXPECT_GT(seen(2), 1000);
  EXPECT_EQ(seen(3), 0);
}

// The head-light would follow the camera; what is left that does are the highlights of `specular`.
TEST(Renderer, AWallLooksTheSameFromEverywhere) {
  const World world = world_of(
      "<light directional='true' dir='1 0.3 -0.4' specular='0 0 0'/><geom type='box' size='0.1 9 9' pos='4 0 "
      "0'/>");
  const int ahead = grey_of(world, camera_at({0, 0, 0}), choice(0)).at<uchar>(240, 320);
  EXPECT_GT(ahead, 40);
  EXPECT_LT(ahead, 250);
  for (const double yaw_deg : {-25.0, -10.0, 15.0, 28.0}) {
    EXPECT_EQ(grey_of(world, camera_at({0.5, 1, 0.2}, yaw_deg), choice(0)).at<uchar>(240, 320), ahead)
        << yaw_deg;
  }
}

const char* const kCrowd = R"(
  <light directional='true' castshadow='false' dir='1 0.3 -0.4'/>
  <geom type='plane' size='9 9 1' material='mirror'/>
  <geom type='sphere' size='0.5' pos='3 0 2.5' rgba='1 0 0 1'/><geom type='capsule' size='0.1 1' pos='3 1.2 1'/>
  <geom type='cylinder' size='0.2 0.4' pos='2 -1.1 0.4'/><geom type='ellipsoid' size='0.1 0.2 0.6' pos='-2 0 1'/>
  <geom type='box' size='0.3 0.1 0.2' pos='1.2 0.75 0.2' euler='10 20 30'/><geom type='box' size='3 0.1 2' pos='0 3 2'/>)";

TEST(Renderer, SameBytesFromEveryRendererAndThread) {
  const World world = world_of(kCrowd);
  for (const int samples : {0, 4}) {
    const cv::Mat first = grey_of(world, camera_at({0, 0, 0.35}), choice(samples, true));
    cv::Mat second;
    std::thread([&] { second = grey_of(world, camera_at({0, 0, 0.35}), choice(samples, true)); }).join();
    EXPECT_EQ(cv::norm(first, second, cv::NORM_INF), 0);

    // Two renderers in one thread, taken in turn.
    Renderer a(world, kWidth_px, kHeight_px, choice(samples, true)), b(world, 320, 200, choice(0));
    a.update_scene(*world.make_data());
    b.update_scene(*world.make_data());
    cv::Mat image, other;
    a.render_grey(camera_at({0, 0, 0.35}, 90), image);
    b.render_grey(camera_at({0, 0, 0.35}), other);
    a.render_grey(camera_at({0, 0, 0.35}), image);
    EXPECT_EQ(cv::norm(first, image, cv::NORM_INF), 0);
  }
}

TEST(Renderer, LeavingOutTheInvisibleChangesNoPixel) {
  const World world = world_of(kCrowd);
  // With shadows on, nothing is left out; no light of this scene throws any.
  for (const double yaw_deg : {0.0, 40.0, 90.0, 180.0, 250.0}) {
    for (const bool reflections : {false, true}) {
      const Renderer::Camera camera = camera_at({0, 0, 0.35}, yaw_deg);
      const cv::Mat culled = grey_of(world, camera, choice(0, reflections, false));
      const cv::Mat whole = grey_of(world, camera, choice(0, reflections, true));
      EXPECT_EQ(cv::norm(culled, whole, cv::NORM_INF), 0) << yaw_deg;
    }
  }
}

TEST(Renderer, FloorReflectsWhenAsked) {
  const World world = world_of(kCrowd);
  const cv::Mat with = grey_of(world, camera_at({0, 0, 0.35}), choice(0, true));
  const cv::Mat without = grey_of(world, camera_at({0, 0, 0.35}), choice(0, false));
  EXPECT_GT(cv::norm(with.rowRange(260, 480), without.rowRange(260, 480), cv::NORM_INF), 20);
}

}  // namespace
}  // namespace groundloop::sim
