#include "bench/metrics/truth/map_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/truth/truth_world.h"

namespace groundloop::bench {
namespace {

using slam::GridGeometry;
using slam::OccupancyMap;
using slam::Pose;

/// A map of 0.1 m cells drawn with the top row first: '#' occupied, '.' free, '?' unknown.
OccupancyMap drawn(const std::vector<std::string>& picture, double x_min_m = 0, double y_min_m = 0) {
  OccupancyMap map;
  map.geometry = {0.1, x_min_m, y_min_m, static_cast<int>(picture[0].size()),
                  static_cast<int>(picture.size())};
  for (int row = map.geometry.rows - 1; row >= 0; --row) {
    for (const char c : picture[row]) map.value.push_back(c == '#' ? 1.0F : c == '.' ? 0.0F : 0.5F);
  }
  return map;
}

/// 'S' face seen, '-' crossed, ' ' unseen.
std::vector<uint8_t> sight_of(const std::vector<std::string>& picture) {
  std::vector<uint8_t> sight;
  for (auto line = picture.rbegin(); line != picture.rend(); ++line) {
    for (const char c : *line)
      sight.push_back(c == 'S' ? sim::kFaceSeen : c == '-' ? sim::kCrossed : sim::kUnseen);
  }
  return sight;
}

/// A wall two cells thick, seen from the left: 4 wall cells, 16 free cells.
class WallScore : public testing::Test {
 protected:
  MapScore score(const std::vector<std::string>& estimate, const Pose& T_world_map = Pose::Identity()) const {
    return score_map(truth_, sight_, drawn(estimate), T_world_map);
  }
  OccupancyMap truth_ = drawn({"....##..", "....##..", "....##..", "....##.."});
  std::vector<uint8_t> sight_ = sight_of({"----S   ", "----S   ", "----S   ", "----S   "});
};

TEST_F(WallScore, PerfectMapScoresExactlyOne) {
  const MapScore s = score({"....#???", "....#???", "....#???", "....#???"});
  EXPECT_EQ(s.scored_cells(), 20);
  EXPECT_EQ(s.wall_cells(), 4);
  EXPECT_EQ(map_metrics(s), (Metrics{{"map.f1", 1},
                                     {"map.iou", 1},
                                     {"map.mcc", 1},
                                     {"map.precision", 1},
                                     {"map.recall", 1},
                                     {"map.brier", 0},
                                     {"map.false_free_m2", 0},
                                     {"map.wall_offset_mean_m", 0},
                                     {"map.wall_offset_p95_m", 0}}));
}

TEST_F(WallScore, OneCellInFrontIsWithinTheToleranceOfF1Only) {
  const MapScore s = score({"...#????", "...#????", "...#????", "...#????"});
  EXPECT_EQ(*s.f1(), 1);
  EXPECT_EQ(*s.iou(), 0);
  // tp 0, fp 4, fn 4, tn 12: -16 / sqrt(4 * 4 * 16 * 16)
  EXPECT_DOUBLE_EQ(*s.mcc(), -0.25);
  // 4 free cells called occupied, 4 wall cells unknown
  EXPECT_DOUBLE_EQ(*s.brier(), (4 * 1.0 + 4 * 0.25) / 20);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_mean_m"), -0.1, 1e-12);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_p95_m"), 0.1, 1e-12);
}

TEST_F(WallScore, OneCellBehindIsWithinTheToleranceToo) {
  const MapScore s = score({".....#??", ".....#??", ".....#??", ".....#??"});
  EXPECT_EQ(*s.precision(), 1);
  EXPECT_EQ(*s.recall(), 1);
  EXPECT_EQ(s.false_free_m2(), 0);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_mean_m"), 0.1, 1e-12);
}

TEST_F(WallScore, TwoCellsOffIsWrong) {
  const MapScore front = score({"..#.....", "..#.....", "..#.....", "..#....."});
  EXPECT_EQ(*front.f1(), 0);
  EXPECT_NEAR(front.false_free_m2(), 4 * 0.01, 1e-12);
  EXPECT_NEAR(map_metrics(front).at("map.wall_offset_mean_m"), -0.2, 1e-12);
  const MapScore behind = score({"......#.", "......#.", "......#.", "......#."});
  EXPECT_EQ(*behind.f1(), 0);
  EXPECT_FALSE(behind.precision());
  EXPECT_NEAR(behind.false_free_m2(), 4 * 0.01, 1e-12);
  EXPECT_NEAR(map_metrics(behind).at("map.wall_offset_mean_m"), 0.2, 1e-12);
}

TEST_F(WallScore, UnknownIsNeitherFreeNorOccupied) {
  const MapScore s = score({"????????", "????????", "????????", "????????"});
  EXPECT_EQ(s.wall_unknown, 4);
  EXPECT_EQ(s.free_unknown, 16);
  EXPECT_EQ(
      map_metrics(s),
      (Metrics{
          {"map.f1", 0}, {"map.iou", 0}, {"map.recall", 0}, {"map.brier", 0.25}, {"map.false_free_m2", 0}}));
}

TEST_F(WallScore, HandCountedMixture) {
  const MapScore s = score({
      "....#???",  // found
      "....#???",  // found
      "....?...",  // unknown, but its neighbour above is occupied
      "#.......",  // called free, no neighbour occupied; a phantom far in front
  });
  EXPECT_EQ(s.wall_occupied, 2);
  EXPECT_EQ(s.wall_unknown, 1);
  EXPECT_EQ(s.wall_free, 1);
  EXPECT_EQ(s.free_occupied, 1);
  EXPECT_EQ(s.free_free, 15);
  EXPECT_DOUBLE_EQ(*s.precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(*s.recall(), 3.0 / 4);
  EXPECT_DOUBLE_EQ(*s.f1(), 2 * (2.0 / 3) * 0.75 / (2.0 / 3 + 0.75));
  EXPECT_DOUBLE_EQ(*s.iou(), 2.0 / 5);
  EXPECT_DOUBLE_EQ(*s.mcc(), (2.0 * 15 - 1 * 2) / std::sqrt(3.0 * 4 * 16 * 17));
  EXPECT_DOUBLE_EQ(*s.brier(), (0.25 + 1 + 1) / 20);
  EXPECT_NEAR(s.false_free_m2(), 0.01, 1e-12);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_mean_m"), -0.4 / 3, 1e-12);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_p95_m"), 0.4, 1e-12);
}

TEST_F(WallScore, GradedValuesCountInBrier) {
  OccupancyMap estimate = truth_;
  for (float& value : estimate.value) value = value > 0.5F ? 0.75F : 0.25F;
  EXPECT_DOUBLE_EQ(*score_map(truth_, sight_, estimate, Pose::Identity()).brier(), 0.0625);
}

TEST_F(WallScore, UnseenGeometryIsNotScored) {
  // row 0: the rays pass below what occupies the column (crossed, no face seen)
  sight_ = sight_of({"----S   ", "----S   ", "----S   ", "------  "});
  const MapScore s = score({"....#???", "....#???", "....#???", "........"});
  EXPECT_EQ(s.wall_cells(), 3);
  EXPECT_EQ(s.free_cells(), 16);
  EXPECT_EQ(*s.iou(), 1);
  EXPECT_EQ(*s.recall(), 1);
  EXPECT_EQ(s.false_free_m2(), 0);
}

TEST_F(WallScore, NothingSeenMeasuresNothing) {
  sight_.assign(sight_.size(), sim::kUnseen);
  EXPECT_EQ(map_metrics(score({"....#???", "....#???", "....#???", "....#???"})), Metrics{});
}

TEST_F(WallScore, MapIsMovedByThePlanarPartOfThePose) {
  // the same wall in a map frame turned by 90 degrees: map x = world y - 0.1, map y = 0.8 - world x
  const OccupancyMap estimate =
      drawn({"????", "????", "????", "####", "....", "....", "....", "...."}, -0.1, 0);
  Pose T_map_world = Pose::Identity();
  T_map_world.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_map_world.translation() << 0.3, 0, 5;
  const MapScore s = score_map(truth_, sight_, estimate, T_map_world.inverse());
  EXPECT_EQ(*s.iou(), 1);
  EXPECT_EQ(*s.brier(), 0);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_p95_m"), 0, 1e-12);
}

TEST_F(WallScore, SmallShiftOfTheFrameKeepsTheCells) {
  Pose T_world_map = Pose::Identity();
  T_world_map.translation().x() = 0.04;  // less than half a cell: the nearest cell is the same
  EXPECT_EQ(*score({"....#???", "....#???", "....#???", "....#???"}, T_world_map).iou(), 1);
  T_world_map.translation().x() = 0.1;
  const MapScore s = score({"...#????", "...#????", "...#????", "...#????"}, T_world_map);
  EXPECT_EQ(*s.iou(), 1);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_p95_m"), 0, 1e-12);
}

TEST_F(WallScore, CoarserEstimateIsReadAtTheCentresOfTheTruth) {
  OccupancyMap coarse;
  coarse.geometry = {0.2, 0, 0, 4, 2};
  coarse.value = {0, 0, 1, 0.5, 0, 0, 1, 0.5};
  EXPECT_EQ(*score_map(truth_, sight_, coarse, Pose::Identity()).iou(), 1);
}

TEST_F(WallScore, P95IsTheDistanceThat95PercentDoNotExceed) {
  MapScore s = score({"....#???", "....#???", "....#???", "....#???"});
  s.wall_offsets_m.assign(95, 0.1);
  s.wall_offsets_m.insert(s.wall_offsets_m.end(), 5, -2.0);
  EXPECT_EQ(map_metrics(s).at("map.wall_offset_p95_m"), 0.1);
  EXPECT_NEAR(map_metrics(s).at("map.wall_offset_mean_m"), (9.5 - 10) / 100, 1e-12);
  s.wall_offsets_m.push_back(-2.0);
  EXPECT_EQ(map_metrics(s).at("map.wall_offset_p95_m"), 2.0);
}

TEST_F(WallScore, PrefixNamesTheVariant) {
  const Metrics metrics =
      map_metrics(score({"....#???", "....#???", "....#???", "....#???"}), "map.with_true_poses.");
  EXPECT_EQ(metrics.at("map.with_true_poses.f1"), 1);
}

TEST_F(WallScore, SightOfAnotherGridIsRefused) {
  sight_.pop_back();
  EXPECT_THROW(score({"....#???", "....#???", "....#???", "....#???"}), std::invalid_argument);
}

}  // namespace
}  // namespace groundloop::bench
