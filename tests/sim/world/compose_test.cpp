#include "sim/world/compose.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>

#include "sim/world/world.h"
#include "tests/sim/world/scratch.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

class ComposeTest : public Scratch {
 protected:
  void SetUp() override { ::testing::internal::CaptureStdout(); }
  void TearDown() override { EXPECT_EQ(::testing::internal::GetCapturedStdout(), ""); }

  /// A robot file around the content of its root body.
  static std::string robot(const std::string& head,
                           const std::string& content = "<geom name='hull' size='0.1'/>") {
    return "<mujoco>" + head + "<worldbody><body name='base'><freejoint/>" + content +
           "</body></worldbody></mujoco>";
  }
  static int geom(const World& world, const char* name) {
    const int id = mj_name2id(&world.model(), mjOBJ_GEOM, name);
    EXPECT_GE(id, 0) << name;
    return id;
  }
};

TEST_F(ComposeTest, DefaultsStayInTheirFile) {
  const World world = World::load(scenario(
      R"(<mujoco>
        <default>
          <geom rgba="1 0 0 1" condim="1"/>
          <default class="visual"><geom group="2"/></default>
        </default>
        <worldbody>
          <geom name="wall" size="1"/>
          <body><geom name="table" size="1"/><geom name="picture" class="visual" size="1"/></body>
        </worldbody></mujoco>)",
      robot(R"(<default class="main">
          <geom condim="4"/>
          <default class="visual"><geom group="1"/></default>
        </default>)",
            "<geom name='hull' size='0.1'/><geom name='paint' class='visual' size='0.1'/>")));
  const mjModel& model = world.model();
  for (const char* name : {"wall", "table", "picture"}) {
    EXPECT_EQ(model.geom_rgba[4 * geom(world, name) + 1], 0) << name;
    EXPECT_EQ(model.geom_condim[geom(world, name)], 1) << name;
  }
  for (const char* name : {"hull", "paint"}) {
    EXPECT_EQ(model.geom_rgba[4 * geom(world, name) + 1], 0.5F) << name;  // MuJoCo's own default
    EXPECT_EQ(model.geom_condim[geom(world, name)], 4) << name;
  }
  EXPECT_EQ(model.geom_group[geom(world, "picture")], 2);
  EXPECT_EQ(model.geom_group[geom(world, "paint")], 1);
}

TEST_F(ComposeTest, WorldInDegreesRobotInRadians) {
  const World world = World::load(scenario(
      R"(<mujoco><compiler eulerseq="XYZ"/>
        <worldbody>
          <geom name="turned" type="box" size="1 2 3" euler="90 0 30"/>
          <geom name="about_axis" type="box" size="1 2 3" axisangle="0 0 2 45"/>
          <body><joint name="door" axis="0 0 1" limited="true" range="-90 45"/>
            <joint name="drawer" type="slide" limited="true" range="0 0.5"/><geom size="0.1"/></body>
        </worldbody></mujoco>)",
      robot("<compiler angle='radian'/>", "<geom name='hull' type='box' size='1 2 3' euler='0 0 0.5'/>")));
  const auto rotation = [&](const char* name) {
    const mjtNum* q = world.model().geom_quat + 4 * geom(world, name);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  };
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const double pi = std::numbers::pi;
  // Fixed axes: first about x, then about the world's z.
  EXPECT_TRUE(rotation("turned").isApprox(
      (AngleAxisd(pi / 6, Vector3d::UnitZ()) * AngleAxisd(pi / 2, Vector3d::UnitX())).toRotationMatrix(),
      1e-12));
  EXPECT_TRUE(
      rotation("about_axis").isApprox(AngleAxisd(pi / 4, Vector3d::UnitZ()).toRotationMatrix(), 1e-12));
  EXPECT_TRUE(rotation("hull").isApprox(AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix(), 1e-12));
  const int door = mj_name2id(&world.model(), mjOBJ_JOINT, "door");
  EXPECT_NEAR(world.model().jnt_range[2 * door], -pi / 2, 1e-12);
  EXPECT_NEAR(world.model().jnt_range[2 * door + 1], pi / 4, 1e-12);
  EXPECT_NEAR(world.model().jnt_range[2 * mj_name2id(&world.model(), mjOBJ_JOINT, "drawer") + 1], 0.5, 1e-12);
}

TEST_F(ComposeTest, AngleOrLengthThatCannotBeToldIsReported) {
  const auto ambiguous = scenario(
      R"(<mujoco><default>
        <joint range="0 90"/></default><worldbody><body><joint/><geom size="0.1"/></body></worldbody></mujoco>)",
      robot("<compiler angle='radian'/>"));
  const auto problems = problems_of([&] { World::load(ambiguous); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].line, 2);
  EXPECT_THAT(problems[0].wanted, HasSubstr("the same <compiler angle>"));
}

TEST_F(ComposeTest, PlaceFromTheWorldSolverFromTheRobot) {
  const World world = World::load(
      scenario("<mujoco><option gravity='0 0 -1.62' timestep='0.01' iterations='7'/><visual><map "
               "fogstart='9'/></visual>"
               "<keyframe><key qpos='1 2 3'/></keyframe></mujoco>",
               robot("<option timestep='0.001' cone='elliptic'/><visual><map fogstart='1'/></visual>")));
  EXPECT_DOUBLE_EQ(world.model().opt.gravity[2], -1.62);
  EXPECT_DOUBLE_EQ(world.model().opt.timestep, 0.001);
  EXPECT_EQ(world.model().opt.iterations, 100);  // MuJoCo's own default
  EXPECT_EQ(world.model().opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(world.model().vis.map.fogstart, 9);
  EXPECT_EQ(world.model().nkey, 0);
}

TEST_F(ComposeTest, ClashesAreAllNamedWithBothPlaces) {
  const auto clashing = scenario(
      "<mujoco>\n<option gravity='0 0 -1'/>\n<asset><material name='black'/></asset>\n"
      "<worldbody><body name='base'/><geom name='hull' size='1'/></worldbody></mujoco>",
      robot("<option gravity='0 0 -9.81'/><asset>\n<material name='black'/></asset>"));
  const auto problems = problems_of([&] { World::load(clashing); });
  ASSERT_EQ(problems.size(), 4U);
  EXPECT_EQ(problems[0].key, "body 'base'");
  EXPECT_EQ(problems[1].key, "geom 'hull'");
  EXPECT_EQ(problems[2].key, "material 'black'");
  EXPECT_EQ(problems[2].file, clashing.world.file);
  EXPECT_EQ(problems[2].line, 3);
  EXPECT_EQ(problems[2].wanted, "another name than in " + clashing.robot.model + ":2");
  EXPECT_EQ(problems[3].key, "option");
  EXPECT_THAT(problems[3].text(), HasSubstr("gravity=\"0 0 -1\""));
}

TEST_F(ComposeTest, CompilerSettingsMatterOnlyToAWorldThatMoves) {
  const std::string setting = "<mujoco><compiler inertiafromgeom='true' boundmass='3'/><worldbody>";
  EXPECT_TRUE(problems_of([&] {
                World::load(scenario(setting + "<geom size='1'/></worldbody></mujoco>", robot("")));
              }).empty());
  const auto problems = problems_of([&] {
    World::load(
        scenario(setting + "<body><freejoint/><geom size='1'/></body></worldbody></mujoco>", robot("")));
  });
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[1].value, "boundmass=\"3\"");
}

}  // namespace
}  // namespace groundloop::sim
