#include "slam/mapping/correlative_search.h"

#include <gtest/gtest.h>

#include <numbers>

#include "slam/mapping/occupied_field.h"
#include "slam/types/counter_random.h"
#include "tests/slam/mapping/drawn_map.h"

namespace groundloop::slam {
namespace {

double uniform(uint64_t stream, uint64_t i) {
  return static_cast<double>(random_bits(1, stream, i) >> 11) * 0x1.0p-53;
}

OccupancyMap random_map(uint64_t seed) {
  OccupancyMap map{{0.05, -2, -1.5, 80, 60}, {}};
  for (size_t i = 0; i < map.geometry.cells(); ++i) {
    map.value.push_back(uniform(seed, i) < 0.1 ? 1.0F : 0.3F);
  }
  return map;
}

std::vector<WeightedPoint> random_points(uint64_t seed, int count) {
  std::vector<WeightedPoint> points;
  for (int i = 0; i < count; ++i) {
    const double x_m = uniform(seed, 3 * i), y_m = uniform(seed, 3 * i + 1), w = uniform(seed, 3 * i + 2);
    points.push_back({{2 * x_m - 1, 1.6 * y_m - 0.8}, 0.3 + w});
  }
  return points;
}

TEST(OccupiedField, DerivativesAreThoseOfTheValue) {
  const OccupancyMap map = random_map(1);
  const OccupiedField field(map, {-1, -1}, {1, 1});
  constexpr double kStep_m = 1e-5;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d p(1.8 * uniform(2, i) - 0.9, 1.8 * uniform(3, i) - 0.9);
    const OccupiedField::Jet jet = field.jet(p);
    EXPECT_NEAR(jet.value, field.value(p), 1e-6);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep_m * Eigen::Vector2d::Unit(axis);
      const auto above = field.jet(p + step), below = field.jet(p - step);
      EXPECT_NEAR(jet.gradient[axis], (above.value - below.value) / (2 * kStep_m), 1e-2);
      const Eigen::Vector2d bend = (above.gradient - below.gradient) / (2 * kStep_m);
      EXPECT_NEAR((jet.hessian.col(axis) - bend).norm(), 0, 1);  // of some 400 per m^2
    }
  }
}

TEST(OccupiedField, IsTheBlurredBeliefAtCentresAndNothingBeyondTheMap) {
  OccupancyMap map{{0.1, 0, 0, 20, 20}, std::vector<float>(400, 0.5F)};
  map.value[map.geometry.index(10, 10)] = 1;
  const OccupiedField field(map, {-1, -1}, {3, 3});
  EXPECT_NEAR(field.value(map.geometry.centre_m(10, 10)), std::pow(0.5 * 4 / 6 + 0.25 * 2 / 6, 2), 1e-6);
  EXPECT_EQ(field.value({-0.5, -0.5}), 0);
  EXPECT_EQ(field.value({-50, 0}), 0);
  const auto centres = field.at_centres();
  const GridGeometry& grid = field.geometry();
  for (int row = 3; row + 3 < grid.rows; ++row) {
    for (int col = 3; col + 3 < grid.cols; ++col) {
      EXPECT_NEAR(centres[grid.index(col, row)], field.value(grid.centre_m(col, row)), 1e-6);
    }
  }
}

/// Best place by trying all of them.
SearchPeak exhaustive(const OccupancyMap& map, const std::vector<WeightedPoint>& points,
                      const SearchWindow& window) {
  const OccupiedField field(map, {-6, -6}, {6, 6});
  const auto values = field.at_centres();
  const GridGeometry& grid = field.geometry();
  double reach_m = 0;
  for (const WeightedPoint& point : points) reach_m = std::max(reach_m, point.p_m.norm());
  const double turn_rad = grid.cell_m / reach_m;
  const auto half = [](double width, double step) {
    return static_cast<int>(std::ceil(width / step - 1e-9));
  };
  const int cols = half(window.half_m.x(), grid.cell_m), rows = half(window.half_m.y(), grid.cell_m);
  SearchPeak best{{}, 0, -1};
  for (int turn = -half(window.half_rad, turn_rad); turn <= half(window.half_rad, turn_rad); ++turn) {
    const double yaw_rad = window.yaw_rad + turn * turn_rad;
    for (int row = -rows; row <= rows; ++row) {
      for (int col = -cols; col <= cols; ++col) {
        const Eigen::Vector2d centre_m = window.centre_m + Eigen::Vector2d(col, row) * grid.cell_m;
        double score = 0;
        for (const WeightedPoint& point : points) {
          const Eigen::Vector2d p_m = centre_m + Eigen::Rotation2Dd(yaw_rad) * point.p_m;
          score += point.weight * values[grid.index(grid.col_of(p_m.x()), grid.row_of(p_m.y()))];
        }
        if (score > best.score) best = {centre_m, yaw_rad, score};
      }
    }
  }
  return best;
}

TEST(CorrelativeSearch, NeverMissesTheBestPlace) {
  for (uint64_t seed = 10; seed < 20; ++seed) {
    const OccupancyMap map = random_map(seed);
    const auto points = random_points(seed + 100, 60);
    // steps do not end on a multiple of the block, and the points reach beyond the map
    const SearchWindow window{{0.313, -0.127}, 0.4, {0.33, 0.57}, 0.3};
    const SearchPeak truth = exhaustive(map, points, window);
    const SearchResult found = search_peaks(map, points, window, {});
    EXPECT_NEAR(found.best.score, truth.score, 1e-3);
    EXPECT_NEAR((found.best.centre_m - truth.centre_m).norm(), 0, 1e-9);
    EXPECT_NEAR(found.best.yaw_rad, truth.yaw_rad, 1e-9);
  }
}

TEST(CorrelativeSearch, TellsTheSecondBestPeak) {
  // The same three posts twice, 0.6 m apart, one of the second three missing.
  const auto post = [](double x, double y) { return PlanRectangle{{x, y}, {x + 0.05, y + 0.05}}; };
  const std::vector<PlanRectangle> posts = {post(0, 0), post(0.2, 0.3), post(-0.3, 0.2), post(0.6, 0.0),
                                            post(0.8, 0.3)};
  const OccupancyMap map = drawn_map(posts, planar(0, 0, 0), {0.05, -2, -2, 80, 80});
  const std::vector<WeightedPoint> points = {{{0.025, 0.025}, 1}, {{0.225, 0.325}, 1}, {{-0.275, 0.225}, 1}};
  const SearchResult found = search_peaks(map, points, {{0.3, 0}, 0, {0.5, 0.2}, 0}, {0.2, 0.1});
  EXPECT_NEAR((found.best.centre_m - Eigen::Vector2d(0, 0)).norm(), 0, 1e-9);
  EXPECT_FALSE(found.at_edge);
  ASSERT_TRUE(found.second);
  EXPECT_NEAR((found.second->centre_m - Eigen::Vector2d(0.6, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(found.second->score / found.best.score, 2.0 / 3, 0.01);  // the posts' blurs touch
}

TEST(CorrelativeSearch, SaysWhenTheBestLiesAtTheEdge) {
  const OccupancyMap map = drawn_map({{{0.5, 0.5}, {0.55, 0.55}}}, planar(0, 0, 0), {0.05, -2, -2, 80, 80});
  const std::vector<WeightedPoint> points = {{{0.025, 0.025}, 1}};
  EXPECT_TRUE(search_peaks(map, points, {{0.25, 0.5}, 0, {0.25, 0.25}, 0}, {}).at_edge);
  EXPECT_FALSE(search_peaks(map, points, {{0.3, 0.5}, 0, {0.25, 0.25}, 0}, {}).at_edge);
}

}  // namespace
}  // namespace groundloop::slam
