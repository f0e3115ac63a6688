#include "slam/mapping/cloud_io.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "slam/types/config.h"
#include "tests/slam/source/temporary_folder.h"

namespace groundloop::slam {
namespace {

std::vector<PlyPoint> two_points() { return {{{1, -2, 3.5F}, 7, 0.25F}, {{-0.1F, 1e-9F, 1e9F}, 255, 4}}; }

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string message_of_reading(const std::string& file) {
  try {
    read_ply(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CloudIo, WritesAPlyThatViewersKnow) {
  const TemporaryFolder folder;
  write_ply(folder.path("cloud.ply"), two_points());
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float sigma\nend_header\n";
  const std::string ply = content(folder.path("cloud.ply"));
  ASSERT_EQ(ply.size(), header.size() + 2 * 19);
  EXPECT_EQ(ply.substr(0, header.size()), header);
  // x = 1 is 0x3F800000, y = -2 is 0xC0000000, z = 3.5 is 0x40600000, sigma = 0.25 is 0x3E800000; low bytes
  // first
  EXPECT_EQ(ply.substr(header.size(), 19), std::string("\x00\x00\x80\x3F\x00\x00\x00\xC0\x00\x00\x60\x40"
                                                       "\x07\x07\x07\x00\x00\x80\x3E",
                                                       19));
}

TEST(CloudIo, ReadsBackTheSame) {
  const TemporaryFolder folder;
  write_ply(folder.path("cloud.ply"), two_points());
  const auto points = read_ply(folder.path("cloud.ply"));
  ASSERT_EQ(points.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(points[i].p_map, two_points()[i].p_map);
    EXPECT_EQ(points[i].grey, two_points()[i].grey);
    EXPECT_EQ(points[i].sigma_m, two_points()[i].sigma_m);
  }
  write_ply(folder.path("cloud.ply"), {});
  EXPECT_TRUE(read_ply(folder.path("cloud.ply")).empty());
}

TEST(CloudIo, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string file = folder.path("cloud.ply");
  EXPECT_EQ(message_of_reading(file), file + ": no such file: wanted a PLY cloud that can be read");
  folder.write("cloud.ply", "ply\nformat ascii 1.0\n");
  EXPECT_EQ(message_of_reading(file), file + ":2: format ascii 1.0: wanted format binary_little_endian 1.0");
  folder.write("cloud.ply", "ply\nformat binary_little_endian 1.0\nelement face 3\n");
  EXPECT_EQ(message_of_reading(file), file + ":3: element face 3: wanted element vertex and their number");
  write_ply(file, two_points());
  const std::string whole = content(file);
  folder.write("cloud.ply", whole.substr(0, whole.size() - 1));
  EXPECT_EQ(message_of_reading(file), file + ": 1 points: wanted 2 points");
  EXPECT_THROW(write_ply(folder.path("no/cloud.ply"), {}), InputError);
}

}  // namespace
}  // namespace groundloop::slam
