#include "sim/generate/free_space.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace groundloop::sim {
namespace {

/// A room of 6 m x 4 m with a pillar of 0.4 m x 0.4 m at the origin, and a table top that hangs at 0.9 m.
World pillar_room() {
  const auto file = std::filesystem::temp_directory_path() / "pillar.xml";
  std::ofstream(file) << R"(<mujoco><worldbody>
    <geom name="floor" type="plane" size="3.2 2.2 1"/>
    <geom type="box" size="3.1 0.05 1" pos="0 2.05 1"/>
    <geom type="box" size="3.1 0.05 1" pos="0 -2.05 1"/>
    <geom type="box" size="0.05 2.1 1" pos="3.05 0 1"/>
    <geom type="box" size="0.05 2.1 1" pos="-3.05 0 1"/>
    <geom name="pillar" type="box" size="0.2 0.2 1" pos="0 0 1"/>
    <geom name="top" type="box" size="0.2 0.2 0.02" pos="2 1 0.9"/>
  </worldbody></mujoco>)";
  return World::load_file(file.string());
}

class PillarRoom : public ::testing::Test {
 protected:
  World world_ = pillar_room();
  World::DataPtr state_ = world_.make_data();
  TruthWorld truth_{world_, *state_};
  FreeSpace space_{truth_, 0.4};
};

TEST_F(PillarRoom, ClearanceIsTheDistanceToTheNearestThingAndNeverMore) {
  for (const auto& [x, y, distance] : {std::tuple(1.2, 0.0, 1.0), {0.0, 1.1, 0.9}, {-2.0, -1.0, 1.0}, {-2.2, 0.0, 0.8}}) {
    EXPECT_LE(space_.clearance_m(x, y), distance) << x << ", " << y;
    EXPECT_GE(space_.clearance_m(x, y), distance - 0.15) << x << ", " << y;
  }
}

TEST_F(PillarRoom, NothingIsFreeInsideThingsBesideThemOrBehindWalls) {
  EXPECT_EQ(space_.clearance_m(0, 0), 0);
  EXPECT_FALSE(space_.holds(0.5, 0)) << "0.3 m from the pillar";
  EXPECT_FALSE(space_.holds(2, 1)) << "below the table";
  EXPECT_EQ(space_.clearance_m(3.15, 0), 0) << "outside of the wall";
  EXPECT_EQ(space_.clearance_m(50, 0), 0) << "outside of the grid";
}

TEST_F(PillarRoom, LinesAreFreeWhenNothingIsNear) {
  EXPECT_TRUE(space_.holds_line({-2, 1}, {1, 1}));
  EXPECT_FALSE(space_.holds_line({-2, 0}, {2, 0})) << "through the pillar";
  EXPECT_FALSE(space_.holds_line({0, -1}, {2, 1.3})) << "below the table";
}

TEST_F(PillarRoom, AreaIsWhatIsLeft) {
  // 5.2 x 3.2 less the rounded squares round pillar (1.2 m) and table; cells cost at most 0.1 m along every edge
  const auto rounded_square = [](double side, double radius) { return side * side + 4 * side * radius + M_PI * radius * radius; };
  const double exact = 5.2 * 3.2 - rounded_square(0.4, 0.4) - rounded_square(0.4, 0.4);
  EXPECT_LE(space_.area_m2(), exact);
  EXPECT_GE(space_.area_m2(), exact - 0.1 * (2 * (5.2 + 3.2) + 2 * (1.6 + 2 * M_PI * 0.4)));
}

}  // namespace
}  // namespace groundloop::sim
