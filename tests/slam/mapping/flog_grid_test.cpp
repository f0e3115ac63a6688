#include "slam/mapping/flog_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace groundloop::slam {
namespace {

FlogOptions two_layers() {
  FlogOptions options;
  options.layer_heights_m = {0, 1, 2};
  options.lambda = 0;
  return options;
}

TEST(FlogCell, ValueCombinesTheThreeMemberships) {
  EXPECT_FLOAT_EQ((FlogCell{0, 0, 0}.value()), 0.5F);        // never observed
  EXPECT_FLOAT_EQ((FlogCell{0, 1, 1}.value()), 1.0F);        // surely occupied
  EXPECT_FLOAT_EQ((FlogCell{1, 0, 1}.value()), 0.0F);        // surely free
  EXPECT_FLOAT_EQ((FlogCell{0.7F, 0.7F, 1}.value()), 0.5F);  // contradictory
  EXPECT_FLOAT_EQ((FlogCell{0, 1, 0.5F}.value()), 0.75F);
}

TEST(FlogGrid, PlainUnionWithoutLambda) {
  FlogGrid grid(two_layers());
  grid.add(3, -2, 1, {0.1F, 0.2F, 0.3F});
  grid.add(3, -2, 1, {0.5F, 0.25F, 0.4F});
  const FlogCell cell = grid.cell(3, -2, 1);
  EXPECT_FLOAT_EQ(cell.empty, 0.1F + 0.5F - 0.05F);
  EXPECT_FLOAT_EQ(cell.occupied, 0.2F + 0.25F - 0.05F);
  EXPECT_FLOAT_EQ(cell.confidence, 0.3F + 0.4F - 0.12F);
}

TEST(FlogGrid, LambdaLetsLaterEvidenceRevise) {
  FlogOptions options = two_layers();
  options.lambda = 0.5;
  FlogGrid grid(options);
  grid.add(0, 0, 0, {0, 0.8F, 1});        // occupied, said one
  grid.add(0, 0, 0, {0.6F, 0.1F, 0.9F});  // rather empty, says the next
  // mu_O = (0.8 + 0.1 - 0.08) (1 - 0.5 * 0.9 * 0.6 * 0.9), mu_E = 0.6 (1 - 0.5 * 0.9 * 0.1 * 0.4)
  EXPECT_FLOAT_EQ(grid.cell(0, 0, 0).occupied, 0.82F * (1 - 0.243F));
  EXPECT_FLOAT_EQ(grid.cell(0, 0, 0).empty, 0.6F * (1 - 0.018F));
}

TEST(FlogGrid, GrowsInEveryDirectionAndKeepsWhatItHas) {
  FlogGrid grid(two_layers());
  const std::vector<std::pair<int, int>> cells = {{0, 0},     {-1, -1},  {5000, 3},
                                                  {-70, 900}, {64, -64}, {63, -65}};
  for (size_t i = 0; i < cells.size(); ++i) {
    grid.add(cells[i].first, cells[i].second, 0, {0, 0.1F * static_cast<float>(i + 1), 1});
  }
  for (size_t i = 0; i < cells.size(); ++i) {
    EXPECT_FLOAT_EQ(grid.cell(cells[i].first, cells[i].second, 0).occupied, 0.1F * static_cast<float>(i + 1))
        << i;
    EXPECT_EQ(grid.cell(cells[i].first, cells[i].second, 1).confidence, 0) << "the other layer is untouched";
  }
  EXPECT_EQ(grid.cell(1, 0, 0).confidence, 0);
  EXPECT_EQ(grid.cell(100000, -100000, 0).confidence, 0);
}

TEST(FlogGrid, MapIsTheRectangleOfObservedCells) {
  FlogGrid grid(two_layers());
  EXPECT_EQ(grid.map().geometry.cells(), 0U);
  grid.add(-3, 10, 0, {1, 0, 1});
  grid.add(5, 12, 1, {0, 1, 1});
  const OccupancyMap map = grid.map();
  EXPECT_EQ(map.geometry.cols, 9);
  EXPECT_EQ(map.geometry.rows, 3);
  EXPECT_DOUBLE_EQ(map.geometry.x_min_m, -0.15);
  EXPECT_DOUBLE_EQ(map.geometry.y_min_m, 0.5);
  EXPECT_EQ(map.at(0, 0), 0.0F);
  EXPECT_EQ(map.at(8, 2), 1.0F);
  EXPECT_EQ(std::count(map.value.begin(), map.value.end(), OccupancyMap::kUnknown), 25);
  EXPECT_EQ(map.at_point(-0.125, 0.525), 0.0F);

  const std::vector<OccupancyMap> layers = grid.layers();
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0].value.size(), map.value.size());
  EXPECT_EQ(layers[0].at(0, 0), 0.0F);
  EXPECT_EQ(layers[0].at(8, 2), OccupancyMap::kUnknown);
  EXPECT_EQ(layers[1].at(8, 2), 1.0F);
}

TEST(FlogGrid, WithoutFusionTheBandHasAPlaneOfItsOwn) {
  FlogOptions options = two_layers();
  options.fuse_layers = false;
  FlogGrid grid(options);
  ASSERT_EQ(grid.plane_count(), 3);
  grid.add(0, 0, 0, {0, 1, 1});
  grid.add(0, 0, 2, {1, 0, 1});
  EXPECT_EQ(grid.map().at(0, 0), 0.0F);
  EXPECT_EQ(grid.layers()[0].at(0, 0), 1.0F);
}

float fused(std::vector<float> beliefs) {
  return fused_belief(beliefs.data(), static_cast<int>(beliefs.size()));
}

TEST(FusedBelief, OneOccupiedLayerMakesTheCellOccupied) {
  EXPECT_FLOAT_EQ(fused({-1, -1, 0.9F, -1}), 0.9F);
  EXPECT_FLOAT_EQ(fused({-1, 0.31F}), 0.31F);
}

TEST(FusedBelief, FreeAsTheLayerKnownBest) {
  EXPECT_FLOAT_EQ(fused({-0.9F, 0, 0, 0}), -0.9F);
  EXPECT_FLOAT_EQ(fused({-0.2F, -0.8F}), -0.8F);
  EXPECT_FLOAT_EQ(fused({0, 0}), 0);
}

TEST(FusedBelief, RisesWithoutAJumpAsALayerTurnsOccupied) {
  float last = fused({-1, -1});
  for (float belief = -1; belief <= 1; belief += 0.001F) {
    const float now = fused({-1, belief});
    EXPECT_GE(now, last - 1e-6F);
    EXPECT_LT(now - last, 0.005F);
    last = now;
  }
  EXPECT_NEAR(last, 1, 0.002);
}

TEST(FlogOptions, LayersMustRise) {
  for (const char* heights : {"[0.05]", "[0, 1, 1]", "[2, 1]"}) {
    FlogOptions options;
    std::vector<Problem> problems;
    read_config(YAML::Load(std::string("layer_heights_m: ") + heights), "a.yaml", options, problems);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].text(),
              std::string("a.yaml:1: layer_heights_m: ") + heights + ": wanted two or more rising heights");
  }
}

}  // namespace
}  // namespace groundloop::slam
