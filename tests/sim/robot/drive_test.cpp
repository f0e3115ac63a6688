#include "sim/robot/drive.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace groundloop::sim {
namespace {

namespace fs = std::filesystem;

/// A plane and a robot file as one world.
World world_with(const std::string& robot_file) {
  const fs::path floor = fs::temp_directory_path() / "groundloop_drive_floor.xml";
  std::ofstream(floor) << "<mujoco><worldbody><geom type='plane' size='5 5 1'/></worldbody></mujoco>";
  Scenario scenario;
  scenario.world.file = floor.string();
  scenario.robot.model = robot_file;
  return World::load(scenario);
}

TEST(Drive, OfThePioneer) {
  const Drive drive = find_drive(world_with("models/robots/p3dx.xml"), "p3dx.xml");
  EXPECT_EQ(drive.limits.wheel_radius_m, 0.0975);
  EXPECT_EQ(drive.limits.track_m, 0.33);
  EXPECT_EQ(drive.limits.wheel_speed_radps, 12.3);
  EXPECT_EQ(drive.limits.wheel_acceleration_radps2, 3.1);
  EXPECT_NE(drive.left_actuator, drive.right_actuator);
  EXPECT_NE(drive.left_qpos, drive.right_qpos);
}

TEST(Drive, OfTheWrongRobotNamesWhatIsMissing) {
  const fs::path box = fs::temp_directory_path() / "groundloop_drive_box.xml";
  std::ofstream(box)
      << "<mujoco><worldbody><body name='box'><freejoint/><geom size='1'/></body></worldbody></mujoco>";
  const World world = world_with(box.string());
  try {
    find_drive(world, "box.xml");
    FAIL() << "a box without wheels was accepted";
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "box.xml: left_wheel: missing: wanted a velocity actuator of that name on a hinge joint of the "
        "robot\n"
        "box.xml: right_wheel: missing: wanted a velocity actuator of that name on a hinge joint of the "
        "robot\n"
        "box.xml: wheel_acceleration_radps2: missing: wanted <custom><numeric> of that name, above 0");
  }
}

}  // namespace
}  // namespace groundloop::sim
