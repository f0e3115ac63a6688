#include <gtest/gtest.h>

#include "slam/mapping/local_map.h"
#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

/// A lap through the furnished laboratory at true poses, scored against its exact occupancy.
MapScore score_of_a_lap(const FlogOptions& options, int points) {
  const RoomWorld world = RoomWorld::laboratory();
  const StereoRig rig = laboratory_rig();
  const std::vector<Pose> lap = laboratory_lap(60);
  const GridGeometry geometry{0.05, -7.2, -4.7, 288, 188};
  FlogGrid grid(options);
  LocalMap local(options, rig);
  for (size_t i = 0; i < lap.size(); ++i) {
    local.add_key_frame(lap[i].translation(), measure(world, rig, lap[i], points, 0.25, i));
    local.add_to(grid);
  }
  return score(grid.map(), world.occupancy(geometry, 0.05, 2.0),
               visible_cells(world, rig, lap, geometry, 0.05, 2.0, 10));
}

TEST(Room, LayersMapTheLaboratory) {
  const MapScore s = score_of_a_lap(FlogOptions{}, 350);
  EXPECT_GT(s.f1, 0.65);
  EXPECT_GT(s.precision, 0.65);
  EXPECT_GT(s.recall, 0.6);
  EXPECT_GT(s.free_recall, 0.85);
}

TEST(Room, TheBandMapsTheLaboratory) {
  FlogOptions options;
  options.fuse_layers = false;
  const MapScore s = score_of_a_lap(options, 350);
  EXPECT_GT(s.f1, 0.65);
  EXPECT_GT(s.precision, 0.65);
  EXPECT_GT(s.recall, 0.55);
  EXPECT_GT(s.free_recall, 0.85);
}

TEST(Room, RaysBelowADeskSpeakAgainstItInTheBandButNotInLayers) {
  // The edge of a desk top 2 m ahead is measured in one key frame of four, the wall below and behind it in
  // all.
  const MapPoint edge{{2.02, 0.02, 0.73}, 0.02, 1}, wall{{5, 0.02, 0.4}, 0.12, 1};
  const auto value_at_edge = [&](bool fuse_layers) {
    FlogOptions options;
    options.fuse_layers = fuse_layers;
    FlogGrid grid(options);
    LocalMap local(options, laboratory_rig());
    for (int i = 0; i < 16; ++i) {
      std::vector<MapPoint> points = {wall};
      if (i % 4 == 0) points.push_back(edge);
      local.add_key_frame({0, 0.02, 0.35}, points);
      local.add_to(grid);
    }
    return grid.map().at_point(2.02, 0.02);
  };
  EXPECT_LT(value_at_edge(false), OccupancyMap::kUnknown);
  EXPECT_GT(value_at_edge(true), 0.9F);
}

}  // namespace
}  // namespace groundloop::slam
