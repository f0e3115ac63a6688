#include "sim/simulation/collision_focus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/robot/drive.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

/// Drives straight on for some seconds with a model of the caller's choice; returns the coordinates.
std::vector<double> drive_on(const World& world, const mjModel& model, CollisionFocus* focus) {
  const Drive drive = find_drive(world, "robot");
  const World::DataPtr state = world.make_data();
  state->ctrl[drive.left_actuator] = state->ctrl[drive.right_actuator] = 8;
  while (state->time < 4) {
    if (focus != nullptr) focus->update(*state);
    mj_step(&model, state.get());
  }
  return {state->qpos, state->qpos + model.nq};
}

TEST(CollisionFocus, ContactsAreTheSame) {
  // a post 2 m ahead, hit off centre, a wall behind it, and things that are never near
  const std::string far =
      "<body pos='9 9 0.5'><geom type='box' size='0.5 0.5 0.5'/><geom size='0.6'/></body>"
      "<body pos='-9 9 0.5'><geom type='cylinder' size='0.5 0.5'/></body>";
  const Scenario scenario = pioneer_in(
      write_world("focus",
                  kFloor + far +
                      "<body name='post' pos='2 0.1 0.5'><geom type='cylinder' size='0.1 0.5'/></body>"
                      "<body pos='2.6 0 0.5'><geom type='box' size='0.1 2 0.5'/></body>"),
      "  speed_mps: 0.2\n  segments: [{straight_m: 1}]\n");
  const World world = World::load(scenario);
  const std::vector<double> everything = drive_on(world, world.model(), nullptr);
  CollisionFocus focus(world, world.model());
  EXPECT_EQ(drive_on(world, focus.model(), &focus), everything) << "to the last bit";
  EXPECT_LT(everything[0], 1.9)
      << "the post stopped it: the test would not notice missing contacts otherwise";
  EXPECT_GT(everything[0], 1.2);
}

TEST(CollisionFocus, LooksOnlyAtWhatIsInReach) {
  const Scenario scenario = pioneer_in(
      write_world(
          "focus",
          kFloor +
              "<body name='near' pos='0.5 0 0.3'><geom type='sphere' size='0.1'/></body>"
              "<body name='far' pos='9 0 0.5'><geom type='sphere' size='0.1'/></body>"
              "<body name='picture' pos='0.5 0 0.5'><geom size='0.1' contype='0' conaffinity='0'/></body>"),
      "  speed_mps: 0.2\n  segments: [{straight_m: 0}]\n");
  const World world = World::load(scenario);
  const auto geoms = [&](const CollisionFocus& focus, const char* body) {
    return focus.model().body_geomnum[mj_name2id(&world.model(), mjOBJ_BODY, body)];
  };
  CollisionFocus focus(world, world.model());
  const World::DataPtr state = world.make_data();
  focus.update(*state);
  EXPECT_EQ(geoms(focus, "world"), 1) << "the floor is always there";
  EXPECT_EQ(geoms(focus, "near"), 1);
  EXPECT_EQ(geoms(focus, "far"), 0);
  EXPECT_EQ(geoms(focus, "picture"), 0);
  state->qpos[0] = 8.5;
  focus.update(*state);
  EXPECT_EQ(geoms(focus, "near"), 0);
  EXPECT_EQ(geoms(focus, "far"), 1);
  EXPECT_EQ(world.model().body_geomnum[1], 1) << "the world's own model is untouched";
}

TEST(CollisionFocus, WhereOtherThingsMoveNothingIsLeftOut) {
  const Scenario scenario = pioneer_in(
      write_world("focus", kFloor + "<body pos='5 5 0.5'><freejoint/><geom size='0.1'/></body>"
                                    "<body name='far' pos='9 0 0.5'><geom type='sphere' size='0.1'/></body>"),
      "  speed_mps: 0.2\n  segments: [{straight_m: 0}]\n");
  const World world = World::load(scenario);
  CollisionFocus focus(world, world.model());
  focus.update(*world.make_data());
  EXPECT_EQ(focus.model().body_geomnum[mj_name2id(&world.model(), mjOBJ_BODY, "far")], 1);
}

}  // namespace
}  // namespace groundloop::sim
