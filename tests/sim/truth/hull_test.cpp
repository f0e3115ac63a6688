#include "sim/truth/hull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/truth/grid_walk.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

TEST(ConvexHull, DropsInnerAndCollinearPoints) {
  const auto hull = convex_hull({{0, 0}, {2, 0}, {1, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 0}});
  EXPECT_EQ(hull, (std::vector<Vector2d>{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}).size(), 1U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2U);
}

TEST(DistanceToHull, InsideEdgeCornerAndDegenerate) {
  const std::vector<Vector2d> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_EQ(distance_to_hull({1, 1}, square), 0);
  EXPECT_NEAR(distance_to_hull({1, -0.5}, square), 0.5, 1e-15);
  EXPECT_NEAR(distance_to_hull({5, 6}, square), 5, 1e-15);
  EXPECT_NEAR(distance_to_hull({3, 4}, {{0, 0}}), 5, 1e-15);
  EXPECT_NEAR(distance_to_hull({1, 1}, {{0, 0}, {4, 0}}), 1, 1e-15);
}

TEST(WalkCells, VisitsEveryCellOfTheSegmentInOrder) {
  const slam::GridGeometry grid{0.5, -1, -1, 4, 4};
  std::vector<std::pair<int, int>> cells;
  const auto visit = [&](int col, int row) { cells.push_back({col, row}); };
  walk_cells(grid, {-0.9, -0.9}, {0.9, -0.05}, visit);
  EXPECT_EQ(cells, (std::vector<std::pair<int, int>>{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {3, 1}}));
  cells.clear();
  walk_cells(grid, {0.9, -0.05}, {-0.9, -0.9}, visit);
  EXPECT_EQ(cells, (std::vector<std::pair<int, int>>{{3, 1}, {2, 1}, {1, 1}, {1, 0}, {0, 0}}));
  cells.clear();
  walk_cells(grid, {-3, 0.2}, {0.1, 0.2}, visit);  // enters from outside
  EXPECT_EQ(cells, (std::vector<std::pair<int, int>>{{0, 2}, {1, 2}, {2, 2}}));
  cells.clear();
  walk_cells(grid, {0.1, 0.2}, {0.1, 0.2}, visit);  // a point
  EXPECT_EQ(cells, (std::vector<std::pair<int, int>>{{2, 2}}));
}

}  // namespace
}  // namespace groundloop::sim
