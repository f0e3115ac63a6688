// Two independent ways to the same geometry: depth images by MuJoCo and OpenGL, rays by Bullet and closed
// forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>

#include "sim/render/renderer.h"
#include "sim/truth/image_truth.h"
#include "sim/truth/truth_world.h"
#include "tests/sim/truth/scene.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;
using slam::Pose;
using slam::StereoRig;

StereoRig vga_rig() {
  StereoRig rig;
  rig.width_px = 640;
  rig.height_px = 480;
  rig.fx_px = rig.fy_px = 576.92;
  rig.cx_px = rig.cx_right_px = 322.25;  // off the centre, so that a wrong principal point shows
  rig.cy_px = 236.5;
  rig.baseline_m = 0.088;
  return rig;
}

Pose look(const Vector3d& p_world, double yaw_rad, double tilt_rad = 0) {
  Pose T_world_left = StereoRig::level_camera(p_world);
  T_world_left.linear() =
      (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * Eigen::AngleAxisd(tilt_rad, Vector3d::UnitY()))
          .toRotationMatrix() *
      T_world_left.linear();
  return T_world_left;
}

/// True within 1 px of an edge in the depth image. On a plane, however slanted, 1/z is linear over the image:
/// its second differences show edges and creases only.
cv::Mat1b near_edges(const cv::Mat& depth_m) {
  constexpr double kEdge = 1e-4;  // [1/m]; a step of 2.5 mm at 5 m
  cv::Mat1b edge(depth_m.size(), 0), near(depth_m.size(), 1);
  const auto bends = [](float a, float b, float c) { return std::abs(1.0 / a - 2.0 / b + 1.0 / c) > kEdge; };
  for (int v = 1; v + 1 < depth_m.rows; ++v) {
    for (int u = 1; u + 1 < depth_m.cols; ++u) {
      const auto z = [&](int du, int dv) { return depth_m.at<float>(v + dv, u + du); };
      edge(v, u) = bends(z(-1, 0), z(0, 0), z(1, 0)) || bends(z(0, -1), z(0, 0), z(0, 1)) ||
                   bends(z(-1, -1), z(0, 0), z(1, 1)) || bends(z(-1, 1), z(0, 0), z(1, -1));
    }
  }
  for (int v = 1; v + 1 < depth_m.rows; ++v) {
    for (int u = 1; u + 1 < depth_m.cols; ++u) {
      near(v, u) = cv::countNonZero(edge(cv::Rect(u - 1, v - 1, 3, 3))) > 0;
    }
  }
  return near;
}

/// The renderer draws curved geoms as facets with their corners on the surface: how deep a facet may lie
/// below it. A tenth more, since depths are compared along the normal where the ray meets the exact surface.
double facet_depth_m(const mjModel& model, int geom) {
  const int type = model.geom_type[geom];
  if (type == mjGEOM_PLANE || type == mjGEOM_BOX || type == mjGEOM_MESH || type == mjGEOM_HFIELD) return 0;
  const double slice = std::numbers::pi / model.vis.quality.numslices;
  const double stack = std::numbers::pi / 2 / model.vis.quality.numstacks;
  const mjtNum* size = model.geom_size + 3 * geom;
  const double radius_m = type == mjGEOM_ELLIPSOID ? std::max({size[0], size[1], size[2]}) : size[0];
  return 1.1 * radius_m * (1 - std::cos(slice) * std::cos(stack));
}

struct Agreement {
  int compared = 0;  ///< pixels away from edges
  int edges = 0;
  int far = 0;         ///< compared pixels whose surfaces are farther apart than allowed
  double worst_m = 0;  ///< largest distance of the two surfaces on flat geoms, along the normal
  double worst_round_m = 0;
};

/// Compares every pixel of one image. Allowed are the steps of the 24-bit depth buffer, the facets of curved
/// geoms and the 1/256 px to which OpenGL rounds the corners of triangles.
void compare(const World& world, const TruthWorld& truth, const cv::Mat& depth_m, const Pose& T_world_left,
             Agreement& sum) {
  const StereoRig rig = vga_rig();
  const mjModel& model = world.model();
  const double near_m = model.vis.map.znear * model.stat.extent;
  const cv::Mat1b edges = near_edges(depth_m);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      if (edges(v, u)) {
        ++sum.edges;
        continue;
      }
      const double z = depth_m.at<float>(v, u);
      const Vector3d ray_left((u - rig.cx_px) / rig.fx_px, (v - rig.cy_px) / rig.fy_px, 1);
      const Vector3d ray = T_world_left.linear() * ray_left;
      const auto hit = truth.cast(T_world_left.translation(), ray, 100);
      ++sum.compared;
      if (!hit) {
        ++sum.far;
        continue;
      }
      const double slope = std::abs(ray.dot(hit->normal_world));
      const double apart_m = std::abs(z - hit->distance_m / ray.norm()) * slope;
      const double facet_m = facet_depth_m(model, hit->geom);
      const double depth_step_m = z * z / near_m / (1 << 24);
      const double rounding_m = z / rig.fx_px / 256;
      if (apart_m > 2 * depth_step_m * slope + 2 * rounding_m + facet_m + 1e-6) ++sum.far;
      double& worst_m = facet_m > 0 ? sum.worst_round_m : sum.worst_m;
      worst_m = std::max(worst_m, apart_m);
    }
  }
}

Agreement compare_images(const World& world, const std::vector<Pose>& T_world_left) {
  const StereoRig rig = vga_rig();
  const auto data = world.make_data();
  const TruthWorld truth(world, *data);
  RenderSettings choice;
  choice.antialiasing = 0;
  Renderer renderer(world, rig.width_px, rig.height_px, choice);
  renderer.update_scene(*data);
  Agreement sum;
  for (const Pose& T : T_world_left) {
    cv::Mat depth_m;
    renderer.render_depth({rig.fx_px, rig.cx_px, rig.cy_px, T}, depth_m);
    compare(world, truth, depth_m, T, sum);
  }
  std::printf(
      "%d pixels compared, %d near edges; %d disagree; at most %.6f m apart on flat, %.6f m on curved "
      "geoms\n",
      sum.compared, sum.edges, sum.far, sum.worst_m, sum.worst_round_m);
  return sum;
}

World world_of(const std::string& xml) {
  const std::string file = testing::TempDir() + "groundloop_render_agreement.xml";
  std::ofstream(file) << xml;
  return World::load_file(file);
}

TEST(RenderAgreement, EveryGeomType) {
  const World world = world_of(
      "<mujoco><statistic extent='10' center='0 0 1'/><visual><map znear='0.005'/></visual>"
      "<asset><hfield name='hill' nrow='5' ncol='7' size='0.8 0.6 0.5 0.2'/>" +
      std::string(kPyramidAsset) +
      "</asset><worldbody>"
      "<geom type='plane' size='0 0 1'/>"
      "<geom type='box' size='0.1 8 3' pos='6 0 2'/><geom type='box' size='8 0.1 3' pos='0 6 2' euler='0 0 "
      "3'/>"
      "<geom type='box' size='0.4 0.3 0.2' pos='3 -1 0.5' euler='20 30 40'/>"
      "<geom type='sphere' size='0.4' pos='3 0.6 0.5'/>"
      "<geom type='ellipsoid' size='0.3 0.5 0.2' pos='3.5 -0.4 1.4' euler='10 20 30'/>"
      "<geom type='capsule' size='0.2 0.4' pos='4 1.7 0.9' euler='30 60 0'/>"
      "<geom type='cylinder' size='0.3 0.4' pos='3.5 -2 1.2' euler='70 10 0'/>"
      "<geom type='mesh' mesh='pyramid' pos='5 3 0.2' euler='0 15 20'/>"
      "<geom type='hfield' hfield='hill' pos='4.5 0.5 0.25'/>"
      "<geom type='box' size='1 1 1' pos='2 0 1' group='3'/>"
      "</worldbody></mujoco>");
  // rendered and cast from the same numbers
  float* data = world.model().hfield_data;
  for (int i = 0; i < world.model().nhfielddata; ++i)
    data[i] = static_cast<float>(0.5 + 0.5 * std::sin(1.7 * i));
  const Agreement sum = compare_images(world, {look({0, 0, 0.9}, 0), look({0, -0.5, 1.8}, 0.3, 0.3)});
  EXPECT_GT(sum.compared, 500000);
  EXPECT_EQ(sum.far, 0);
  EXPECT_LT(sum.worst_m, 5e-4);
}

/// Pixels away from edges whose geom is another one by rays than in the rendered image; counts those
/// compared.
int other_geoms(const World& world, const Pose& T_world_left, int& compared) {
  const StereoRig rig = vga_rig();
  const auto data = world.make_data();
  ImageTruth rendered{
      rig.fx_px, rig.cx_px, rig.cy_px, T_world_left, {}, {}, geom_poses(world.model(), *data)};
  ImageTruth cast = rendered;
  Renderer renderer(world, rig.width_px, rig.height_px, {.antialiasing = 0});
  renderer.update_scene(*data);
  renderer.render_truth({rig.fx_px, rig.cx_px, rig.cy_px, T_world_left}, rendered.depth_m, rendered.geom);
  cast_image_truth(TruthWorld(world, *data), rendered.depth_m.size(), cast);
  cv::Mat depth_m;
  renderer.render_depth({rig.fx_px, rig.cx_px, rig.cy_px, T_world_left}, depth_m);
  EXPECT_EQ(cv::norm(depth_m, rendered.depth_m, cv::NORM_INF), 0);  // one pass or two
  const cv::Mat1b edges = near_edges(depth_m);
  compared += cv::countNonZero(edges == 0);
  return cv::countNonZero((edges == 0) & (rendered.geom != cast.geom));
}

TEST(RenderAgreement, GeomIdsOfEveryPixel) {
  const World lab = World::load_file("models/worlds/lab.xml");
  int compared = 0;
  // Pictures and panels lie flat on what they hang on, by less than an edge shows.
  EXPECT_LT(other_geoms(lab, look({-3, -2.3, 0.35}, 0.4), compared), 0.002 * 640 * 480);
  EXPECT_LT(other_geoms(lab, look({3.5, 2, 1.2}, 3.6, 0.1), compared), 0.002 * 640 * 480);
  EXPECT_GT(compared, 450000);
}

TEST(RenderAgreement, Laboratory) {
  const World world = World::load_file("models/worlds/lab.xml");
  std::vector<Pose> T_world_left;
  for (int i = 0; i < 4; ++i) {
    const double turn_rad = i * std::numbers::pi / 2;
    T_world_left.push_back(look({3.5 * std::sin(turn_rad), -2.3 * std::cos(turn_rad), 0.35}, turn_rad));
  }
  const Agreement sum = compare_images(world, T_world_left);
  EXPECT_GT(sum.compared, 900000);
  EXPECT_EQ(sum.far, 0);
  EXPECT_LT(sum.worst_m, 5e-4);
}

}  // namespace
}  // namespace groundloop::sim
