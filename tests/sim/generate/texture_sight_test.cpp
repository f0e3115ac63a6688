#include "sim/generate/texture_sight.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

namespace groundloop::sim {
namespace {

std::string scratch(const std::string& name) { return (std::filesystem::temp_directory_path() / name).string(); }

/// Squares of two greys, 4 pixels wide: their standard deviation is half the difference.
std::string checkers(const std::string& name, int dark, int light) {
  cv::Mat picture(64, 64, CV_8U);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      picture.at<uint8_t>(y, x) = static_cast<uint8_t>((x / 4 + y / 4) % 2 == 0 ? dark : light);
    }
  }
  cv::imwrite(scratch(name), picture);
  return scratch(name);
}

TEST(PictureContrast, IsTheStandardDeviationWithinPatches) {
  PictureContrast pictures;
  EXPECT_NEAR(pictures.of_file(checkers("strong.png", 100, 140)), 20, 1e-9);
  EXPECT_NEAR(pictures.of_file(checkers("weak.png", 100, 104)), 2, 1e-9);
  EXPECT_EQ(pictures.of_file(scratch("missing.png")), 0);
}

/// A contrasty board to the left of the camera's axis and a dull one to its right, 2 m ahead; plain behind.
TEST(TextureSight, CountsWhatIsContrastyAndInRange) {
  checkers("strong.png", 100, 140);
  checkers("weak.png", 100, 104);
  const std::string file = scratch("boards.xml");
  std::ofstream(file) << R"(<mujoco><asset>
    <texture name="strong" type="2d" file="strong.png"/><texture name="weak" type="2d" file="weak.png"/>
    <material name="strong" texture="strong"/><material name="weak" texture="weak"/></asset><worldbody>
    <geom name="left" type="box" material="strong" size="0.05 2 2" pos="2 2 0"/>
    <geom name="right" type="box" material="weak" size="0.05 2 2" pos="2 -2 0"/>
    <geom name="far" type="box" material="strong" size="0.05 9 9" pos="-14 0 0"/>
    <geom name="near" type="box" material="strong" size="2 0.05 2" pos="0 -4.3 0"/>
  </worldbody></mujoco>)";
  const World world = World::load_file(file);
  const World::DataPtr state = world.make_data();
  const TruthWorld truth(world, *state);
  HeadModel head;
  head.mount.x_m = head.mount.y_m = 0;
  PictureContrast pictures;
  const TextureSight sight(world, read_mjcf(file), truth, head, pictures);
  EXPECT_DOUBLE_EQ(sight.visible(0, 0, 0), 0.5) << "the left half of the image";
  EXPECT_DOUBLE_EQ(sight.visible(0, 1.9, 0), 1);
  EXPECT_DOUBLE_EQ(sight.visible(0, -1.9, 0), 0) << "no contrast";
  EXPECT_DOUBLE_EQ(sight.visible(0, 0, M_PI), 0) << "14 m away";
  EXPECT_DOUBLE_EQ(sight.visible(0, -4.0, -M_PI / 2), 0) << "0.25 m away";
  EXPECT_DOUBLE_EQ(sight.visible(0, -3.0, -M_PI / 2), 1);
}

}  // namespace
}  // namespace groundloop::sim
