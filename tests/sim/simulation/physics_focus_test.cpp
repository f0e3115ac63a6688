#include "sim/simulation/physics_focus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sim/robot/drive.h"
#include "sim/world/scene_motion.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

const std::string kStandStill = "  speed_mps: 0.2\n  segments: [{straight_m: 0}]\n";

/// Coordinates and velocities after every step.
using Motion = std::vector<std::vector<double>>;

/// Drives straight on for some seconds with steps of the caller's choice; what is to be moved is moved.
Motion drive_on(const World& world, SceneMotion& scene,
                const std::function<void(mjData&, bool moved)>& step) {
  const mjModel& model = world.model();
  const Drive drive = find_drive(world, "robot");
  const World::DataPtr state = world.make_data();
  state->ctrl[drive.left_actuator] = state->ctrl[drive.right_actuator] = 8;
  Motion motion;
  scene.place(0);
  while (state->time < 4) {
    step(*state, scene.place(state->time));
    motion.emplace_back(state->qpos, state->qpos + model.nq);
    motion.back().insert(motion.back().end(), state->qvel, state->qvel + model.nv);
  }
  return motion;
}

/// Where the robot gets to, the same by steps of the whole model and by those of the focus.
double way_m(const Scenario& scenario) {
  const World world = World::load(scenario);
  SceneMotion scene(world, scenario);
  const Motion whole = drive_on(world, scene, [&](mjData& state, bool) { mj_step(&scene.model(), &state); });
  scene.place(0);
  PhysicsFocus focus(world, scene.model());
  const Motion focused = drive_on(world, scene, [&](mjData& state, bool moved) {
    if (moved) focus.look_again();
    focus.step(state);
  });
  EXPECT_EQ(focused.size(), whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    if (focused[i] == whole[i]) continue;
    ADD_FAILURE() << "not the same to the last bit from step " << i << " on, at x = " << whole[i][0];
    break;
  }
  return whole.back()[0];
}

/// Whether a geom of that name is among those that the last step was made with.
bool steps_with(const PhysicsFocus& focus, const std::string& name) {
  const mjModel& model = focus.model();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.names + model.name_geomadr[geom] == name) return true;
  }
  return false;
}

const std::string kPost =
    "<body name='post' pos='2 0.1 0.5'><geom name='post' type='cylinder' size='0.1 0.5'/></body>";

/// Things of all kinds that are never near, before and behind in MuJoCo's order.
const std::string kFar =
    "<geom type='box' pos='0 -9 0.5' size='0.5 0.5 0.5'/><light pos='0 0 3'/><site pos='1 1 1'/>"
    "<camera pos='1 1 1'/>"
    "<body pos='9 9 0.5'><geom type='box' size='0.5 0.5 0.5'/><geom size='0.6'/>"
    "<body pos='0 0 1'><geom size='0.3'/></body></body>"
    "<body pos='-9 9 0.5'><geom type='cylinder' size='0.5 0.5'/></body>"
    "<body pos='1 0 0.2'><geom size='0.1' contype='0' conaffinity='0'/></body>";

TEST(PhysicsFocus, MotionIsTheSameThroughContacts) {
  // a post 2 m ahead, part of a thing that begins far away, hit off centre; a wall and a shelf behind it
  const Scenario scenario = pioneer_in(
      write_world("focus",
                  kFloor + kFar + "<body pos='9 0 0'><body pos='-9 0 0'>" + kPost +
                      "</body><geom size='0.2'/></body>"
                      "<geom type='box' pos='2.6 0 0.5' size='0.1 2 0.5'/>"
                      "<body pos='2.4 1 0.5'><geom type='box' size='0.1 0.8 0.5'/><geom size='0.2'/></body>"),
      kStandStill);
  const double there_m = way_m(scenario);
  EXPECT_LT(there_m, 1.9) << "the post stopped it: the test would not notice missing contacts otherwise";
  EXPECT_GT(there_m, 1.2);
}

TEST(PhysicsFocus, MovedFurnitureIsTouchedWhereItStands) {
  const std::string far_post =
      "<body name='far_post' pos='2 5 0.5'><geom type='cylinder' size='0.1 0.5'/></body>";
  const std::string world_file = write_world("focus", kFloor + kFar + kPost + far_post);
  const double free_m = way_m(
      pioneer_in(world_file, kStandStill + "moves: [{at_s: 1, body: post, x_m: 2, y_m: 3, yaw_deg: 0}]\n"));
  EXPECT_GT(free_m, 2.5) << "nothing is left in its way";
  // put there when the robot is 20 cm away
  const std::string swap =
      "moves:\n  - {at_s: 1, body: post, x_m: 2, y_m: 3, yaw_deg: 0}\n"
      "  - {at_s: 1.4, body: far_post, x_m: 1.4, y_m: 0.05, yaw_deg: 0}\n";
  const std::string people =
      "people:\n  - {name: anna, model: " + std::filesystem::absolute("models/people/walker.xml").string() +
      ", speed_mps: 1, way: [{x_m: 0.5, y_m: 2}, {x_m: 0.5, y_m: -2}]}\n";
  const double stopped_m = way_m(pioneer_in(world_file, kStandStill + swap + people));
  EXPECT_LT(stopped_m, 1.4);
  EXPECT_GT(stopped_m, 0.8);
}

TEST(PhysicsFocus, WhatTheModelRefersToByNumberIsStillMeant) {
  const std::string exclude =
      "</worldbody><contact><exclude body1='post' body2='p3dx'/>"
      "<exclude body1='post' body2='p3dx_left_wheel'/></contact><worldbody>";
  const std::string wall = "<body pos='2.9 0 0.5'><geom type='box' size='0.1 2 0.5'/></body>";
  const double through_m =
      way_m(pioneer_in(write_world("focus", kFloor + kFar + kPost + wall + exclude), kStandStill));
  EXPECT_GT(through_m, 2.2) << "driven through the post";
  EXPECT_LT(through_m, 2.8);
  // a post that nothing can touch but the hull, by that pair
  const std::string ghost =
      "<body pos='2 0.1 0.5'><geom name='ghost' type='cylinder' size='0.1 0.5' contype='0' "
      "conaffinity='0'/></body>"
      "</worldbody><contact><pair geom1='ghost' geom2='p3dx_hull'/></contact><worldbody>";
  EXPECT_LT(way_m(pioneer_in(write_world("focus", kFloor + kFar + ghost), kStandStill)), 1.95);
}

TEST(PhysicsFocus, BodiesKeepTheirKin) {
  const World world = World::load(pioneer_in(
      write_world("focus",
                  kFloor + kFar +
                      "<body name='table' pos='0.5 0 0'><geom type='box' pos='0 0 1' size='1 1 0.1'/>"
                      "<body name='cup' pos='0 0 0.1'><geom size='0.1'/></body></body>"),
      kStandStill));
  PhysicsFocus focus(world, world.model());
  focus.step(*world.make_data());
  const mjModel &whole = world.model(), &near = focus.model();
  ASSERT_LT(near.nbody, whole.nbody);
  const auto name = [](const mjModel& model, int body) {
    return std::string(model.names + model.name_bodyadr[body]);
  };
  for (int body = 0; body < near.nbody; ++body) {
    const int same = mj_name2id(&whole, mjOBJ_BODY, name(near, body).c_str());
    EXPECT_EQ(name(near, near.body_parentid[body]), name(whole, whole.body_parentid[same]));
    EXPECT_EQ(name(near, near.body_rootid[body]), name(whole, whole.body_rootid[same]));
    EXPECT_EQ(name(near, near.body_weldid[body]), name(whole, whole.body_weldid[same]));
  }
  for (int joint = 0; joint < near.njnt; ++joint) {
    EXPECT_EQ(name(near, near.jnt_bodyid[joint]), name(whole, whole.jnt_bodyid[joint]));
  }
  for (int dof = 0; dof < near.nv; ++dof) {
    EXPECT_EQ(name(near, near.dof_bodyid[dof]), name(whole, whole.dof_bodyid[dof]));
  }
}

TEST(PhysicsFocus, LooksOnlyAtWhatIsInReach) {
  const Scenario scenario = pioneer_in(
      write_world("focus", kFloor +
                               "<body pos='0.5 0 0.3'><geom name='near' size='0.1'/></body>"
                               "<body name='far' pos='9 0 0.5'><geom name='far' size='0.1'/></body>"
                               "<body pos='0.5 0 0.5'><geom name='picture' size='0.1' contype='0' "
                               "conaffinity='0'/></body>"
                               "<geom name='wall' type='box' pos='0 2 1' size='5 0.1 1'/>"
                               "<geom name='pipe' type='capsule' fromto='-8 -2 0.2 8 -2 0.2' size='0.05'/>"
                               "<geom name='column' type='cylinder' pos='4 -5 2' size='0.1 2'/>"),
      kStandStill);
  const World world = World::load(scenario);
  PhysicsFocus focus(world, world.model());
  const World::DataPtr state = world.make_data();
  const auto step_at = [&](double x_m, double y_m) {
    state->qpos[0] = x_m;
    state->qpos[1] = y_m;
    focus.step(*state);
    std::string names;
    for (const char* name : {"near", "far", "picture", "wall", "pipe", "column"}) {
      if (steps_with(focus, name)) names += std::string(names.empty() ? "" : " ") + name;
    }
    EXPECT_TRUE(steps_with(focus, "floor")) << "always there";
    EXPECT_TRUE(steps_with(focus, "p3dx_hull"));
    EXPECT_FALSE(steps_with(focus, "p3dx_head")) << "to be seen, not to be touched";
    return names;
  };
  EXPECT_EQ(step_at(0, 0), "near");
  EXPECT_EQ(focus.model().nbody, world.model().nbody - 2);
  EXPECT_EQ(step_at(8.5, 0), "far");
  EXPECT_EQ(step_at(5.2, 2), "wall") << "at its end";
  EXPECT_EQ(step_at(5.8, 2), "") << "past it";
  EXPECT_EQ(step_at(-8.2, -2.2), "pipe");
  EXPECT_EQ(step_at(-8.8, -2), "");
  EXPECT_EQ(step_at(4, -4.5), "column");
  EXPECT_EQ(step_at(4, -4), "") << "it is tall, not wide";
  EXPECT_EQ(world.model().nbody, mj_name2id(&world.model(), mjOBJ_BODY, "p3dx_caster_wheel") + 1)
      << "the world's own model is untouched";
}

TEST(PhysicsFocus, TheStateKeepsTheWorldsNumbers) {
  const World world = World::load(pioneer_in(write_world("focus", kFloor + kFar + kPost), kStandStill));
  PhysicsFocus focus(world, world.model());
  const World::DataPtr state = world.make_data();
  for (int i = 0; i < 100; ++i) focus.step(*state);
  EXPECT_NEAR(state->time, 0.2, 1e-12);
  const int post = mj_name2id(&world.model(), mjOBJ_GEOM, "post");
  EXPECT_EQ(state->geom_xpos[3 * post], 2);
  EXPECT_EQ(state->geom_xpos[3 * post + 1], 0.1);
}

TEST(PhysicsFocus, WhereOtherThingsMoveNothingIsLeftOut) {
  const World world = World::load(pioneer_in(
      write_world("focus",
                  kFloor + "<body pos='5 5 0.5'><freejoint/><geom size='0.1'/></body>" + kFar + kPost),
      kStandStill));
  PhysicsFocus focus(world, world.model());
  focus.step(*world.make_data());
  EXPECT_EQ(focus.model().nbody, world.model().nbody);
  EXPECT_EQ(focus.model().ngeom, world.model().ngeom);
}

}  // namespace
}  // namespace groundloop::sim
