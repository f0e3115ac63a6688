#include <gtest/gtest.h>

#include <filesystem>

#include "sim/generate/realize.h"
#include "sim/head/head.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"

namespace groundloop::sim {
namespace {

TEST(ShippedScenarios, AllLoadAndDriveClearOfEverything) {
  int scenarios = 0;
  for (const auto& entry : std::filesystem::directory_iterator("scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    SCOPED_TRACE(entry.path().string());
    ++scenarios;
    const Scenario scenario = realized(load_scenario(entry.path().string()));
    EXPECT_EQ(scenario.name, entry.path().stem()) << "named as its file";
    const World world = World::load(scenario);
    const Simulation simulation(world, load_head(scenario.head.model), scenario);
    EXPECT_GT(simulation.exposures(), 1);
  }
  EXPECT_GE(scenarios, 2);
}

TEST(ShippedScenarios, TheLabDriveIsAsLongAsPromised) {
  const Scenario scenario = load_scenario("scenarios/lab_p3dx.yaml");
  const World world = World::load(scenario);
  const Simulation simulation(world, load_head(scenario.head.model), scenario);
  EXPECT_EQ(simulation.exposures(), 1500);
  EXPECT_GE(simulation.planned_length_m(), 30);

  // one lap is what leads back to the start; 1.2 of them are driven
  double lap_m = 0, driven_m = 0;
  for (size_t i = 0; i < scenario.plan.segments.size(); ++i) {
    const Segment& segment = scenario.plan.segments[i];
    driven_m += segment.straight_m.value_or(0);
    if (segment.arc) driven_m += segment.arc->radius_m * std::abs(segment.arc->angle_deg) * M_PI / 180;
    if (i == 14) lap_m = driven_m;
  }
  EXPECT_NEAR(driven_m, simulation.planned_length_m(), 1e-9);
  EXPECT_GE(driven_m / lap_m, 1.2);
}

/// No ray of the image may start by hitting the robot that carries the camera.
TEST(ShippedScenarios, TheHeadDoesNotSeeItsRobot) {
  const Scenario scenario = load_scenario("scenarios/smoke.yaml");
  const World world = World::load(scenario);
  const World::DataPtr state = world.make_data();
  const mjModel& model = world.model();
  int rays = 0;
  for (const auto& entry : std::filesystem::directory_iterator("models/heads")) {
    SCOPED_TRACE(entry.path().string());
    if (entry.path().stem().string().starts_with("xc55")) continue;  // an arm's
    const slam::StereoRig rig = load_head(entry.path().string()).rig();
    const mjtNum* q = state->qpos + model.jnt_qposadr[model.body_jntadr[world.robot_body()]];
    slam::Pose T_world_body = slam::Pose::Identity();
    T_world_body.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).toRotationMatrix();
    T_world_body.translation() << q[0], q[1], q[2];
    for (const double camera_x_m : {0.0, rig.baseline_m}) {
      const slam::Pose T_world_camera =
          T_world_body * rig.T_body_left * Eigen::Translation3d(camera_x_m, 0, 0);
      for (int v = 0; v < rig.height_px; v += 8) {
        for (int u = 0; u < rig.width_px; u += 8) {
          const Eigen::Vector3d ray =
              T_world_camera.linear() *
              Eigen::Vector3d((u - rig.cx_px) / rig.fx_px, (v - rig.cy_px) / rig.fy_px, 1).normalized();
          const Eigen::Vector3d from = T_world_camera.translation();
          const mjtByte drawn_groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
          int geom = -1;
          mj_ray(&model, state.get(), from.data(), ray.data(), drawn_groups, 1, -1, &geom);
          ASSERT_FALSE(geom >= 0 && world.is_robot_geom(geom))
              << mj_id2name(&model, mjOBJ_GEOM, geom) << " at pixel " << u << ", " << v;
          ++rays;
        }
      }
    }
  }
  EXPECT_GT(rays, 1000);
}

}  // namespace
}  // namespace groundloop::sim
