// What the bench says of the drive itself, whatever the SLAM makes of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

/// A wall to the left of the way, 0.2 m clear of a robot that drives straight on.
constexpr const char* kWorld = R"(<mujoco><worldbody>
  <geom name="floor" type="plane" size="5 5 0.1"/>
  <geom name="wall" type="box" pos="2 0.5 0.5" size="2 0.05 0.5"/>
</worldbody></mujoco>)";

class DriveRun : public testing::Test {
 protected:
  /// drive.collisions of 20 pairs (2.5 s, 1 m) straight on.
  /// @param diameter_ratio  of the wheels; 1.5 turns left with a radius of 0.8 m
  int collisions(const std::string& name, double diameter_ratio) {
    const auto models = std::filesystem::absolute("models");
    workspace_.write("world.xml", kWorld);
    const std::string scenario = workspace_.write(
        name + ".yaml",
        "format: 1\nname: " + name +
            "\nworld: world.xml\nrobot: {model: " + (models / "robots/p3dx.xml").string() +
            ", drive: {diameter_ratio: " + std::to_string(diameter_ratio) +
            "}}\nhead: {model: " + (models / "heads/sth_mdcs.yaml").string() +
            "}\nrender: {profile: fast}\nplan: {speed_mps: 0.4, segments: [{straight_m: 2}]}\n");
    const Answer answer = groundloop({"run", scenario, "--frames", "20", "--out", workspace_.path(name)});
    EXPECT_LE(answer.exit_code, 1) << answer.out << answer.err;
    return nlohmann::json::parse(text_of(workspace_.path(name + "/metrics.json")))
        .at("drive.collisions")
        .get<int>();
  }
  const Workspace workspace_;
};

TEST_F(DriveRun, CountsThePairsAtWhichTheRobotTouchesSomething) {
  EXPECT_EQ(collisions("straight", 1), 0);
  const int touching = collisions("bent", 1.5);
  EXPECT_GE(touching, 3);  // against the wall, and held by it
  EXPECT_LE(touching, 15);
}

}  // namespace
}  // namespace groundloop::bench
