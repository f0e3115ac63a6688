#include "slam/mapping/map_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "slam/types/config.h"
#include "tests/slam/source/temporary_folder.h"

namespace groundloop::slam {
namespace {

OccupancyMap three_by_two() {
  OccupancyMap map;
  map.geometry = {0.05, -1.25, 0.4, 3, 2};
  map.value = {0.0F, 0.5F, 1.0F,   // the lower row
               0.3F, 0.7F, 0.5F};  // the upper row
  return map;
}

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string message_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MapIo, PgmBeginsWithTheUpperRow) {
  const TemporaryFolder folder;
  write_map(folder.path("map"), three_by_two());
  const std::string header = "P5\n3 2\n255\n", pgm = content(folder.path("map.pgm"));
  ASSERT_EQ(pgm.size(), header.size() + 6);
  EXPECT_EQ(pgm.substr(0, header.size()), header);
  std::vector<int> grey;
  for (size_t i = header.size(); i < pgm.size(); ++i) grey.push_back(static_cast<uint8_t>(pgm[i]));
  EXPECT_EQ(grey, (std::vector<int>{178, 76, 127, 254, 127, 0}));
}

TEST(MapIo, YamlIsThatOfMapServer) {
  const TemporaryFolder folder;
  write_map(folder.path("map"), three_by_two());
  EXPECT_EQ(content(folder.path("map.yaml")),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.25, 0.4, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.35\n");
}

TEST(MapIo, MapServerCallsEveryValueAsTheMapDoes) {
  // map_server: p = (255 - grey) / 255, occupied above 0.65, free below 0.35, else unknown.
  const TemporaryFolder folder;
  OccupancyMap map;
  map.geometry = {0.05, 0, 0, 1001, 1};
  for (int i = 0; i <= 1000; ++i) map.value.push_back(static_cast<float>(i) / 1000);
  write_map(folder.path("map"), map);
  const std::string pgm = content(folder.path("map.pgm"));
  for (int i = 0; i <= 1000; ++i) {
    const double p = (255 - static_cast<uint8_t>(pgm[pgm.size() - 1001 + i])) / 255.0;
    if (i < 347) {
      EXPECT_LT(p, 0.35) << i;
    } else if (i >= 350 && i <= 646) {
      EXPECT_TRUE(p >= 0.35 && p <= 0.65) << i;
    } else if (i > 653) {
      EXPECT_GT(p, 0.65) << i;
    }
  }
}

TEST(MapIo, ReadsBackToHalfAGreyLevel) {
  const TemporaryFolder folder;
  write_map(folder.path("map"), three_by_two());
  const OccupancyMap map = read_map(folder.path("map.yaml"));
  EXPECT_EQ(map.geometry.cols, 3);
  EXPECT_EQ(map.geometry.rows, 2);
  EXPECT_EQ(map.geometry.cell_m, 0.05);
  EXPECT_EQ(map.geometry.x_min_m, -1.25);
  EXPECT_EQ(map.geometry.y_min_m, 0.4);
  for (size_t i = 0; i < map.value.size(); ++i) EXPECT_NEAR(map.value[i], three_by_two().value[i], 0.5 / 254);
  EXPECT_EQ(map.at(1, 0), OccupancyMap::kUnknown);
}

TEST(MapIo, ReadsMapsOfOtherMakers) {
  const TemporaryFolder folder;
  folder.write("theirs.pgm",
               std::string("P5\n# made by map_saver\n3 1\n255\n") + "\xFE\xCD" + std::string(1, '\0'));
  folder.write(
      "theirs.yaml",
      "image: theirs.pgm\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_THAT(read_map(folder.path("theirs.yaml")).value, testing::ElementsAre(0.0F, 0.5F, 1.0F));
  folder.write(
      "theirs.yaml",
      "image: theirs.pgm\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.9\nfree_thresh: 0.1\n"
      "negate: 1\n");
  EXPECT_THAT(read_map(folder.path("theirs.yaml")).value, testing::ElementsAre(1.0F, 0.5F, 0.0F));
}

TEST(MapIo, AMapWithoutCellsIsOneUnknownCell) {
  const TemporaryFolder folder;
  write_map(folder.path("map"), OccupancyMap{});
  EXPECT_THAT(read_map(folder.path("map.yaml")).value, testing::ElementsAre(0.5F));
}

TEST(MapIo, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { write_map(folder.path("no/map"), three_by_two()); }),
            folder.path("no/map.pgm") + ": cannot be created: wanted a file that can be written");
  EXPECT_EQ(message_of([&] { read_map(folder.path("map.yaml")); }),
            folder.path("map.yaml") + ": no such file: wanted a YAML file that can be read");
  folder.write("map.yaml", "image: map.pgm\nresolution: fine\norigin: [0, 0, 0.5]\n");
  EXPECT_EQ(message_of([&] { read_map(folder.path("map.yaml")); }),
            folder.path("map.yaml") + ":2: resolution: fine: wanted a number of at least 1e-06\n" +
                folder.path("map.yaml") + ":3: origin: [0, 0, 0.5]: wanted x, y and a yaw of 0");
  folder.write("map.yaml", "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  const std::string wanted = ": wanted an 8-bit PGM image (P5)";
  EXPECT_EQ(message_of([&] { read_map(folder.path("map.yaml")); }),
            folder.path("map.pgm") + ": no such file" + wanted);
  folder.write("map.pgm", "P2\n1 1\n255\n0\n");
  EXPECT_EQ(message_of([&] { read_map(folder.path("map.yaml")); }),
            folder.path("map.pgm") + ": another kind of file" + wanted);
  folder.write("map.pgm", "P5\n2 2\n255\nabc");
  EXPECT_EQ(message_of([&] { read_map(folder.path("map.yaml")); }),
            folder.path("map.pgm") + ": ends too early" + wanted);
}

TEST(MapIo, NothingIsLeftBesideTheFiles) {
  const TemporaryFolder folder;
  write_map(folder.path("map"), three_by_two());
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("map.pgm", "map.yaml"));
}

TEST(MapIo, OctomapHasTheLayersAtTheirHeights) {
  const TemporaryFolder folder;
  OccupancyMap low = three_by_two(), high = three_by_two();
  high.value.assign(6, OccupancyMap::kUnknown);
  high.value[0] = 1;
  write_octomap(folder.path("map.bt"), {low, high}, {0.05, 0.5, 1.0});
  octomap::OcTree tree(folder.path("map.bt"));
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.05);
  const auto called = [&](double x, double y, double z) {
    const octomap::OcTreeNode* node = tree.search(x, y, z);
    return node == nullptr ? "unknown" : tree.isNodeOccupied(node) ? "occupied" : "free";
  };
  // Columns at x = -1.225, -1.175, -1.125; rows at y = 0.425, 0.475.
  for (const double z : {0.075, 0.275, 0.475}) {
    EXPECT_STREQ(called(-1.225, 0.425, z), "free") << z;
    EXPECT_STREQ(called(-1.175, 0.425, z), "unknown") << z;
    EXPECT_STREQ(called(-1.125, 0.425, z), "occupied") << z;
    EXPECT_STREQ(called(-1.225, 0.475, z), "free") << z;
    EXPECT_STREQ(called(-1.175, 0.475, z), "occupied") << z;
  }
  for (const double z : {0.525, 0.975}) {
    EXPECT_STREQ(called(-1.225, 0.425, z), "occupied") << z;
    EXPECT_STREQ(called(-1.125, 0.425, z), "unknown") << z;
  }
  EXPECT_STREQ(called(-1.225, 0.425, 0.025), "unknown");
  EXPECT_STREQ(called(-1.225, 0.425, 1.025), "unknown");
}

}  // namespace
}  // namespace groundloop::slam
