// People, moved furniture and lamps: where things are, and how bright, at any time.
#include "sim/world/scene_motion.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/world/lighting.h"
#include "tests/sim/world/scratch.h"

namespace groundloop::sim {
namespace {

using ::testing::ElementsAre;

const std::string kRoom = R"(<mujoco><worldbody>
  <light name='lamp' pos='0 0 3'/><light name='sun' directional='true'/>
  <geom type='plane' size='9 9 1'/>
  <body name='corner' pos='2 1 0' quat='0 0 0 1'>
    <body name='chair' pos='1 0 0.4' quat='0.7071067811865476 0 0 0.7071067811865476'>
      <geom name='seat' type='box' size='0.2 0.2 0.02'/>
      <geom name='back' type='box' size='0.02 0.2 0.2' pos='-0.2 0 0.2'/>
    </body>
  </body>
</worldbody></mujoco>)";
const std::string kRobot =
    "<mujoco><worldbody><body name='robot'><freejoint/><geom name='hull' "
    "size='0.1'/></body></worldbody></mujoco>";
const std::string kPerson = R"(<mujoco><worldbody><body name='someone'>
  <geom name='chest' type='ellipsoid' pos='0 0 1.2' size='0.1 0.2 0.3'/>
  <body name='left_leg' pos='0 0.1 0.9'><geom name='left_shin' type='capsule' size='0.05' fromto='0 0 0 0 0 -0.85'/></body>
  <body name='right_leg' pos='0 -0.1 0.9'><geom name='right_shin' type='capsule' size='0.05' fromto='0 0 0 0 0 -0.85'/></body>
</body></worldbody></mujoco>)";

class SceneMotionTest : public Scratch {
 protected:
  Scenario room() const {
    Scenario s = scenario(kRoom, kRobot);
    s.robot.start.x_m = -5;
    return s;
  }
  Scenario with_person() const {
    Scenario s = room();
    Person person;
    person.name = "anna";
    person.model = write("person.xml", kPerson);
    person.speed_mps = 0.5;
    person.way = {{0, 0}, {0, 4}};
    s.people = {person};
    return s;
  }
  /// Positions after kinematics at a time.
  static World::DataPtr state_at(const World& world, SceneMotion& motion, double time_s) {
    World::DataPtr data = world.make_data();
    motion.place(time_s);
    mj_kinematics(&motion.model(), data.get());
    return data;
  }
  static Eigen::Vector3d geom_at(const World& world, const mjData& data, const char* name) {
    const int id = mj_name2id(&world.model(), mjOBJ_GEOM, name);
    EXPECT_GE(id, 0) << name;
    return Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * id);
  }
};

TEST_F(SceneMotionTest, APersonWalksAndItsFeetStayOnTheFloor) {
  const Scenario s = with_person();
  const World world = World::load(s);
  SceneMotion motion(world, s);
  EXPECT_TRUE(motion.anything_moves());
  for (const double time_s : {0.0, 1.3, 2.0, 3.7, 100.0}) {
    const auto data = state_at(world, motion, time_s);
    const Stance stance = Walk(s.people[0]).at(time_s);
    const Eigen::Vector3d chest = geom_at(world, *data, "anna/chest");
    EXPECT_TRUE(chest.head<2>().isApprox(stance.p_world, 1e-9)) << time_s;
    // the middle of the left shin swings forward: along y, the way
    const Eigen::Vector3d shin = geom_at(world, *data, "anna/left_shin");
    EXPECT_NEAR(shin.y() - stance.p_world.y(), 0.425 * std::sin(stance.swing_rad), 1e-9) << time_s;
    EXPECT_NEAR(shin.x(), -0.1, 1e-9) << "left of someone who walks along y";
    const double foot_z_m = 0.9 - chest.z() + 1.2;  // hip above floor after the bob
    EXPECT_NEAR(chest.z() - 1.2 + 0.9 - 0.9 * std::cos(stance.swing_rad), 0, 1e-9) << foot_z_m;
  }
}

TEST_F(SceneMotionTest, PeopleTouchNothingAndAreKnownAsPeople) {
  const Scenario s = with_person();
  const World world = World::load(s);
  int people = 0;
  for (int geom = 0; geom < world.model().ngeom; ++geom) {
    if (!world.is_person_geom(geom)) continue;
    ++people;
    EXPECT_EQ(world.model().geom_contype[geom] | world.model().geom_conaffinity[geom], 0);
    EXPECT_FALSE(world.is_robot_geom(geom));
  }
  EXPECT_EQ(people, 3);
}

TEST_F(SceneMotionTest, TwoPeopleMayShareAFile) {
  Scenario s = with_person();
  s.people.push_back(s.people[0]);
  s.people[1].name = "ben";
  EXPECT_GE(mj_name2id(&World::load(s).model(), mjOBJ_GEOM, "ben/chest"), 0);
}

TEST_F(SceneMotionTest, AMovedBodyStandsElsewhereFromItsTimeOn) {
  Scenario s = room();
  s.moves = {{5, "chair", -2, 3, 90, 0}};
  const World world = World::load(s);
  SceneMotion motion(world, s);
  // nested in a corner that is turned by 180 degrees: the chair is at (1, 1), and looks along -y
  EXPECT_TRUE(
      geom_at(world, *state_at(world, motion, 4.99), "seat").isApprox(Eigen::Vector3d(1, 1, 0.4), 1e-9));
  const auto after = state_at(world, motion, 5);
  EXPECT_TRUE(geom_at(world, *after, "seat").isApprox(Eigen::Vector3d(-2, 3, 0.4), 1e-9));
  EXPECT_TRUE(geom_at(world, *after, "back").isApprox(Eigen::Vector3d(-2, 2.8, 0.6), 1e-9))
      << "looks along +y";
  EXPECT_TRUE(geom_at(world, *state_at(world, motion, 0), "seat").isApprox(Eigen::Vector3d(1, 1, 0.4), 1e-9))
      << "and back in time";
}

TEST_F(SceneMotionTest, PlaceSaysWhenFurnitureStandsElsewhere) {
  Scenario s = with_person();
  s.moves = {{5, "chair", -2, 3, 90, 0}};
  const World world = World::load(s);
  SceneMotion motion(world, s);
  EXPECT_FALSE(motion.place(4)) << "people alone do not count";
  EXPECT_TRUE(motion.place(6));
  EXPECT_FALSE(motion.place(7));
  EXPECT_TRUE(motion.place(1));
}

TEST_F(SceneMotionTest, WrongMovesNameTheBody) {
  Scenario s = room();
  s.file = "s.yaml";
  s.moves = {{1, "chair", 0, 0, 0, 7},
             {1, "corner", 0, 0, 0, 8},
             {1, "robot", 0, 0, 0, 9},
             {1, "sofa", 0, 0, 0, 10}};
  const World world = World::load(s);
  std::vector<std::string> lines;
  for (const Problem& p : problems_of([&] { const SceneMotion motion(world, s); })) lines.push_back(p.text());
  EXPECT_THAT(
      lines,
      ElementsAre(
          "s.yaml:7: moves[0].body: chair: wanted a body that does not stand on one that is moved itself",
          "s.yaml:9: moves[2].body: robot: wanted a body that has no joint",
          "s.yaml:10: moves[3].body: sofa: wanted the name of a body of the world"));
}

TEST_F(SceneMotionTest, APersonsFileHoldsBodiesAndGeomsOnly) {
  Scenario s = with_person();
  s.people[0].model = write("bad.xml",
                            "<mujoco><option/><worldbody><body><freejoint/><geom size='1'/></body>"
                            "<body/></worldbody></mujoco>");
  std::vector<std::string> wanted;
  for (const Problem& p : problems_of([&] { World::load(s); })) wanted.push_back(p.wanted);
  EXPECT_THAT(wanted,
              ElementsAre("only compiler, asset and worldbody in a person's file", "only bodies and geoms",
                          "a type of its own: a person's file has no defaults", "one body that holds all"));
}

TEST_F(SceneMotionTest, LampsAreSwitchedDimmedAndCombined) {
  Scenario s = room();
  LightChange off, dim;
  off.at_s = 2;
  off.for_s = 3;
  off.light = "lamp";
  off.factor = 0;
  dim.at_s = 4;
  dim.factor = 0.5;
  s.lights = {off, dim};
  const World world = World::load(s);
  const Lighting lighting(world.model(), s);
  EXPECT_THAT(lighting.at(0).light, ElementsAre(1, 1));
  EXPECT_THAT(lighting.at(2).light, ElementsAre(0, 1));
  EXPECT_THAT(lighting.at(4.5).light, ElementsAre(0, 0.5F));
  EXPECT_THAT(lighting.at(5).light, ElementsAre(0.5F, 0.5F));
  EXPECT_EQ(lighting.at(3).ambient, 1) << "a lamp is not the light from everywhere";
  EXPECT_EQ(lighting.at(5).ambient, 0.5F) << "all is";
}

TEST_F(SceneMotionTest, FlickerKeepsToItsDepthAndRateAndSeed) {
  Scenario s = room();
  LightChange flicker;
  flicker.light = "ambient";
  flicker.factor = 0.8;
  flicker.flicker = Flicker{10, 0.5};
  s.lights = {flicker};
  const World world = World::load(s);
  const Lighting lighting(world.model(), s);
  EXPECT_EQ(lighting.at(0.101).ambient, lighting.at(0.199).ambient);
  EXPECT_NE(lighting.at(0.101).ambient, lighting.at(0.201).ambient);
  double low = 1, high = 0;
  for (int i = 0; i < 1000; ++i) {
    low = std::min<double>(low, lighting.at(i * 0.1 + 0.05).ambient);
    high = std::max<double>(high, lighting.at(i * 0.1 + 0.05).ambient);
  }
  EXPECT_NEAR(low, 0.4, 0.005);
  EXPECT_NEAR(high, 0.8, 0.005);
  s.seed = 2;
  EXPECT_NE(Lighting(world.model(), s).at(0.1).ambient, lighting.at(0.1).ambient);
}

TEST_F(SceneMotionTest, AnUnknownLightNamesThoseThereAre) {
  Scenario s = room();
  LightChange change;
  change.light = "candle";
  change.line = 3;
  s.lights = {change};
  s.file = "s.yaml";
  const World world = World::load(s);
  const auto problems = problems_of([&] { const Lighting lighting(world.model(), s); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].text(), "s.yaml:3: lights[0].light: candle: wanted one of: all, ambient, lamp, sun");
}

}  // namespace
}  // namespace groundloop::sim
