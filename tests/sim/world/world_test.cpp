#include "sim/world/world.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/sim/world/scratch.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

const char* const kRobot = R"(<mujoco>
  <worldbody>
    <body name="base" pos="0 0 0.1">
      <freejoint/>
      <geom name="hull" type="box" size="0.2 0.1 0.05"/>
      <body name="arm"><joint name="elbow"/><geom name="hand" size="0.02"/></body>
    </body>
  </worldbody>
</mujoco>)";

class WorldTest : public Scratch {
 protected:
  void SetUp() override { ::testing::internal::CaptureStdout(); }
  void TearDown() override { EXPECT_EQ(::testing::internal::GetCapturedStdout(), ""); }
};

TEST_F(WorldTest, LaboratoryIsStaticAndFillsItsRoom) {
  const World world = World::load_file("models/worlds/lab.xml");
  EXPECT_EQ(world.model().nv, 0);
  EXPECT_GT(world.model().ngeom, 500);
  EXPECT_EQ(world.robot_body(), -1);
  EXPECT_FALSE(world.is_robot_geom(0));
  const auto data = world.make_data();
  const int wall = mj_name2id(&world.model(), mjOBJ_GEOM, "north_wall");
  ASSERT_GE(wall, 0);
  EXPECT_NEAR(data->geom_xpos[3 * wall + 1] - world.model().geom_size[3 * wall + 2], 4.5, 1e-9);
}

TEST_F(WorldTest, CamerasSeeTheSameBrightnessFromEverywhere) {
  const World world =
      World::load_file(write("w.xml", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"));
  const mjModel& model = world.model();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(model.vis.headlight.diffuse[i], 0);
    EXPECT_EQ(model.vis.headlight.specular[i], 0);
    EXPECT_GT(model.vis.headlight.ambient[i], 0);
  }
  EXPECT_NEAR(model.vis.map.znear * model.stat.extent, 0.04, 1e-6);
  EXPECT_GE(model.vis.map.zfar * model.stat.extent, 60 - 1e-3);
}

TEST_F(WorldTest, StartPoseKeepsHeightAndOrientationOfTheFile) {
  Scenario scenario = this->scenario(
      "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/></worldbody></mujoco>", kRobot);
  scenario.robot.start = {.x_m = 2, .y_m = -1, .yaw_deg = 90};
  const World world = World::load(scenario);
  const auto data = world.make_data();
  const int body = world.robot_body();
  EXPECT_STREQ(mj_id2name(&world.model(), mjOBJ_BODY, body), "base");
  EXPECT_NEAR(data->xpos[3 * body], 2, 1e-12);
  EXPECT_NEAR(data->xpos[3 * body + 1], -1, 1e-12);
  EXPECT_NEAR(data->xpos[3 * body + 2], 0.1, 1e-12);
  EXPECT_NEAR(data->xmat[9 * body + 3], 1, 1e-12);  // the body's x axis is the world's y axis
  EXPECT_TRUE(world.is_robot_geom(mj_name2id(&world.model(), mjOBJ_GEOM, "hand")));
  EXPECT_FALSE(world.is_robot_geom(mj_name2id(&world.model(), mjOBJ_GEOM, "floor")));
}

TEST_F(WorldTest, ARobotWithoutANameIsTheRobotAllTheSame) {
  const Scenario scenario = this->scenario(
      "<mujoco/>", "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>");
  for (const Looks looks : {Looks::kAll, Looks::kNone}) {
    const World world = World::load(scenario, looks);
    ASSERT_GE(world.robot_body(), 0);
    EXPECT_STREQ(mj_id2name(&world.model(), mjOBJ_BODY, world.robot_body()), "robot");
    EXPECT_TRUE(world.is_robot_geom(0));
  }
}

TEST_F(WorldTest, MissingAssetsAreAllNamedWithTheirPlace) {
  const std::string file = write("w.xml", R"(<mujoco>
  <compiler texturedir="generated" meshdir="shapes"/>
  <asset>
    <texture name="wood" type="2d" file="wood.png"/>
    <mesh name="cup" file="cup.obj"/>
  </asset>
</mujoco>)");
  const auto problems = problems_of([&] { World::load_file(file); });
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].file, file);
  EXPECT_EQ(problems[0].line, 4);
  EXPECT_EQ(problems[0].key, "texture 'wood'");
  EXPECT_EQ(problems[0].value, path("generated/wood.png"));
  EXPECT_THAT(problems[0].wanted, HasSubstr("made by the build"));
  EXPECT_EQ(problems[1].line, 5);
  EXPECT_EQ(problems[1].value, path("shapes/cup.obj"));
  EXPECT_EQ(problems[1].wanted, "an existing file");
}

TEST_F(WorldTest, IncludesMeshesAndFoldersOfTheUser) {
  write("shapes/tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  write("parts/room.xml",
        "<mujocoinclude><geom name='pillar' type='cylinder' size='0.1 1'/>"
        "<include file='parts/more.xml'/></mujocoinclude>");
  write("parts/more.xml", "<mujocoinclude><geom name='solid' type='mesh' mesh='tetra'/></mujocoinclude>");
  const World world = World::load_file(write("w.xml", R"(<mujoco>
  <compiler meshdir="shapes"/>
  <asset><mesh file="tetra.obj"/></asset>
  <worldbody><include file="parts/room.xml"/></worldbody>
</mujoco>)"));
  EXPECT_GE(mj_name2id(&world.model(), mjOBJ_GEOM, "pillar"), 0);
  const int solid = mj_name2id(&world.model(), mjOBJ_GEOM, "solid");
  ASSERT_GE(solid, 0);
  EXPECT_EQ(world.model().geom_type[solid], mjGEOM_MESH);
}

TEST_F(WorldTest, MissingAndRepeatedIncludesAreNamed) {
  const std::string missing =
      write("a.xml", "<mujoco>\n<worldbody>\n<include file='gone.xml'/></worldbody></mujoco>");
  auto problems = problems_of([&] { World::load_file(missing); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].line, 3);
  EXPECT_EQ(problems[0].value, path("gone.xml"));

  const std::string loop = write("b.xml", "<mujoco>\n<include file='b.xml'/></mujoco>");
  problems = problems_of([&] { World::load_file(loop); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].wanted, HasSubstr("once only"));
}

TEST_F(WorldTest, MuJoCosErrorsPointToTheUsersFile) {
  write("part.xml", "<mujocoinclude>\n\n<geom name='odd' size='1' colour='red'/></mujocoinclude>");
  const std::string schema =
      write("w.xml", "<mujoco><worldbody>\n<include file='part.xml'/></worldbody></mujoco>");
  auto problems = problems_of([&] { World::load_file(schema); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].file, path("part.xml"));
  EXPECT_EQ(problems[0].line, 3);
  EXPECT_EQ(problems[0].key, "geom 'odd'");
  EXPECT_THAT(problems[0].value, HasSubstr("unrecognized attribute: 'colour'"));

  const std::string semantic =
      write("v.xml",
            "<mujoco><worldbody>\n<geom/>\n\n<geom name='flat' type='box' size='1'/></worldbody></mujoco>");
  problems = problems_of([&] { World::load_file(semantic); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].file, semantic);
  EXPECT_GT(problems[0].line, 1) << problems[0].text();

  const std::string broken = write("x.xml", "<mujoco>\n<worldbody>\n</mujoco>");
  problems = problems_of([&] { World::load_file(broken); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].wanted, "well-formed XML");
  EXPECT_GT(problems[0].line, 0);

  problems = problems_of([&] { World::load_file(path("nowhere.xml")); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].value, "no such file");
}

TEST_F(WorldTest, ARobotNeedsOneFreeJoint) {
  const auto scenario =
      this->scenario("<mujoco/>", "<mujoco>\n<worldbody><body><geom size='1'/></body></worldbody></mujoco>");
  const auto problems = problems_of([&] { World::load(scenario); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].file, scenario.robot.model);
  EXPECT_THAT(problems[0].text(), HasSubstr("0 bodies with a free joint"));
}

TEST_F(WorldTest, MuJoCosFatalErrorsAreExceptions) {
  World::load_file(write("w.xml", "<mujoco/>"));
  EXPECT_THROW(mju_error("no way out"), std::runtime_error);
}

}  // namespace
}  // namespace groundloop::sim
