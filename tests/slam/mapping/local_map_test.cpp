#include "slam/mapping/local_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

/// The constants of the formulas' own check, on one band.
FlogOptions paper_band() {
  FlogOptions options;
  options.k_empty = 0.10, options.k_occupied = 0.25, options.k_confidence = 0.20;
  options.sigma_disparity_px = 0.25, options.sigma_max_m = 0.30;
  options.fuse_layers = false;
  options.ends_deny_empty = false;
  options.lambda = 0;
  options.max_range_m = 20;
  return options;
}
int band_of(const FlogOptions& options) { return options.layer_count(); }

/// Share of trust that is left at a range, with the laboratory's rig and the default noise.
double trust_at(double range_m) {
  const FlogOptions options = paper_band();
  const StereoRig rig = laboratory_rig();
  const double rho_v_m =
      std::sqrt(options.sigma_max_m * rig.fx_px * rig.baseline_m / options.sigma_disparity_px);
  return 0.5 * (1 - std::tanh(4 * (range_m - rho_v_m) / rho_v_m));
}

FlogGrid grid_of(const FlogOptions& options, const Eigen::Vector3d& head, std::vector<MapPoint> points) {
  FlogGrid grid(options);
  LocalMap local(options, laboratory_rig());
  local.add_key_frame(head, points);
  local.add_to(grid);
  return grid;
}

TEST(LocalMap, OneRayGivesTheFormulasValues) {
  const FlogOptions options = paper_band();
  // From x = 0.01 along a row of cells to x = 2.01, sigma 0.1: the band is d = 0.2 wide on both sides.
  const FlogGrid grid = grid_of(options, {0.01, 0.02, 0.3}, {{{2.01, 0.02, 0.3}, 0.1, 0.5}});
  const double q = 0.5 * trust_at(2), k_occupied = 0.25 * q * (2 * 0.05 / 0.2);
  for (int col = 0; col < 50; ++col) {
    // Along-ray distance of the middle of the chord through the cell.
    const double begin_m = std::max(0.0, col * 0.05 - 0.01), end_m = std::min(2.2, (col + 1) * 0.05 - 0.01);
    const double rho = 0.5 * (begin_m + end_m), x = (2 - rho) / 0.2;
    const FlogCell cell = grid.cell(col, 0, band_of(options));
    if (col > 44) {
      EXPECT_EQ(cell.confidence, 0) << "behind the band, column " << col;
      continue;
    }
    EXPECT_NEAR(cell.empty, x >= 1 ? 0.1 * q : x > 0 ? 0.1 * q * x * x : 0, 1e-6) << col;
    EXPECT_NEAR(cell.occupied, std::abs(x) < 1 ? k_occupied * (1 - x * x) : 0, 1e-6) << col;
    EXPECT_NEAR(cell.confidence, 0.2 * q, 1e-6) << col;
  }
  EXPECT_EQ(grid.cell(20, 1, band_of(options)).confidence, 0) << "a ray is one cell wide";
}

TEST(LocalMap, NearPointsHaveABandOfACell) {
  const FlogOptions options = paper_band();
  const FlogGrid grid = grid_of(options, {0, 0.02, 0.3}, {{{1.025, 0.02, 0.3}, 0.001, 1}});
  // d = h: the cell of the point has its middle at the point itself, its neighbours lie a whole d away.
  EXPECT_NEAR(grid.cell(20, 0, band_of(options)).occupied, 0.25 * trust_at(1.025), 1e-6);
  EXPECT_NEAR(grid.cell(19, 0, band_of(options)).occupied, 0, 1e-6);
  EXPECT_NEAR(grid.cell(19, 0, band_of(options)).empty, 0.1 * trust_at(1.025), 1e-6);
}

TEST(LocalMap, TrustIsHalfWhereDepthNoiseReachesItsLimit) {
  const FlogOptions options = paper_band();
  const StereoRig rig = laboratory_rig();
  const double rho_v_m = std::sqrt(0.30 * rig.fx_px * rig.baseline_m / 0.25);
  EXPECT_NEAR(rho_v_m, 7.8, 0.01);
  const FlogGrid grid = grid_of(options, {0, 0.02, 0.3}, {{{rho_v_m, 0.02, 0.3}, 0.3, 1}});
  EXPECT_NEAR(grid.cell(20, 0, band_of(options)).empty, 0.05, 1e-6);
}

TEST(LocalMap, RaysVisitEveryCellTheyCross) {
  const FlogOptions options = paper_band();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-4, 4);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d head(uniform(random), uniform(random), 0.3),
        end(uniform(random), uniform(random), 0.3);
    const FlogGrid grid = grid_of(options, head, {{end, 0.01, 1}});
    // Fine steps along the ray land in visited cells only, and a visited cell has a step near it.
    for (double s = 0; s <= 1; s += 1e-3) {
      const Eigen::Vector3d p = head + s * (end - head);
      const int col = static_cast<int>(std::floor(p.x() / 0.05)),
                row = static_cast<int>(std::floor(p.y() / 0.05));
      EXPECT_GT(grid.cell(col, row, band_of(options)).confidence, 0) << "ray " << i << " at " << s;
    }
    const OccupancyMap map = grid.map();
    const Eigen::Vector2d along = (end - head).head<2>().normalized();
    for (int row = 0; row < map.geometry.rows; ++row) {
      for (int col = 0; col < map.geometry.cols; ++col) {
        if (map.at(col, row) == OccupancyMap::kUnknown) continue;
        const Eigen::Vector2d to = map.geometry.centre_m(col, row) - head.head<2>();
        EXPECT_LT(std::abs(along.x() * to.y() - along.y() * to.x()), 0.05 / std::sqrt(2.0) + 1e-9);
      }
    }
  }
}

TEST(LocalMap, AKeyFrameChangesACellOnceByItsStrongestRay) {
  const FlogOptions options = paper_band();
  const Eigen::Vector3d head(0, 0.02, 0.3);
  const MapPoint weak{{2, 0.02, 0.3}, 0.02, 0.4}, strong{{2, 0.02, 0.3}, 0.02, 0.9};
  const FlogGrid both = grid_of(options, head, {weak, strong, weak, strong});
  const FlogGrid one = grid_of(options, head, {strong});
  for (int col = 0; col < 45; ++col) {
    const FlogCell a = both.cell(col, 0, band_of(options)), b = one.cell(col, 0, band_of(options));
    EXPECT_EQ(a.empty, b.empty);
    EXPECT_EQ(a.occupied, b.occupied);
    EXPECT_EQ(a.confidence, b.confidence);
  }
}

TEST(LocalMap, SeveralKeyFramesUniteBeforeTheyAreAdded) {
  const FlogOptions options = paper_band();
  FlogGrid grid(options);
  LocalMap local(options, laboratory_rig());
  const MapPoint point{{2, 0.02, 0.3}, 0.02, 1};
  EXPECT_TRUE(local.empty());
  for (int i = 0; i < 3; ++i) local.add_key_frame({0, 0.02, 0.3}, std::span(&point, 1));
  EXPECT_FALSE(local.empty());
  EXPECT_EQ(grid.cell(10, 0, band_of(options)).confidence, 0);
  local.add_to(grid);
  EXPECT_TRUE(local.empty());
  EXPECT_NEAR(grid.cell(10, 0, band_of(options)).empty, 1 - std::pow(1 - 0.1 * trust_at(2), 3), 1e-6);
  local.add_to(grid);  // nothing more to add
  EXPECT_NEAR(grid.cell(10, 0, band_of(options)).empty, 1 - std::pow(1 - 0.1 * trust_at(2), 3), 1e-6);
}

TEST(LocalMap, MovingItsWindowChangesNothing) {
  // Heads far apart in one local map, against a local map each.
  const FlogOptions options = paper_band();
  FlogGrid together(options), apart(options);
  LocalMap local(options, laboratory_rig()), fresh(options, laboratory_rig());
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-3, 3);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d head(5.0 * (i % 4) - 8, -4.0 * (i % 3), 0.3);
    std::vector<MapPoint> points;
    for (int k = 0; k < 20; ++k)
      points.push_back({head + Eigen::Vector3d(uniform(random), uniform(random), 0.2), 0.05, 1});
    local.add_key_frame(head, points);
    fresh.add_key_frame(head, points);
    fresh.add_to(apart);
  }
  local.add_to(together);
  const OccupancyMap a = together.map(), b = apart.map();
  ASSERT_EQ(a.value.size(), b.value.size());
  for (size_t i = 0; i < a.value.size(); ++i) EXPECT_NEAR(a.value[i], b.value[i], 1e-5);
}

TEST(LocalMap, EvidenceStaysInItsLayer) {
  FlogOptions options;
  options.layer_heights_m = {0.05, 0.5, 1.0, 1.5, 2.0};
  // From height 0.35 at x = 0 to 1.35 at x = 4: the ray passes 0.5 at 0.6 m and 1.0 at 2.6 m.
  const FlogGrid grid = grid_of(options, {0, 0.02, 0.35}, {{{4, 0.02, 1.35}, 0.02, 1}});
  const auto observed = [&](double x_m, int layer) {
    return grid.cell(static_cast<int>(std::floor(x_m / 0.05)), 0, layer).confidence > 0;
  };
  EXPECT_TRUE(observed(0.3, 0) && !observed(0.3, 1));
  EXPECT_TRUE(!observed(0.9, 0) && observed(0.9, 1));
  EXPECT_TRUE(!observed(2.4, 2) && observed(2.8, 2));
  EXPECT_TRUE(observed(3.99, 2) && !observed(3.99, 3));
  EXPECT_GT(grid.cell(79, 0, 2).occupied, 0.1);
}

TEST(LocalMap, PointsOutsideTheBandAreNoObstacles) {
  FlogOptions options = paper_band();
  const Eigen::Vector3d head(0, 0.02, 0.35);
  // A floor point, one in the mirror of the floor, the ceiling: free only where the ray is in the band.
  for (const double z : {0.0, -1.0, 2.5}) {
    const FlogGrid grid = grid_of(options, head, {{{3, 0.02, z}, 0.05, 1}});
    const double leaves_m = 3 * (z > 1 ? 2.0 - 0.35 : 0.35 - 0.05) / std::abs(z - 0.35);
    for (int col = 0; col < 70; ++col) {
      const FlogCell cell = grid.cell(col, 0, band_of(options));
      EXPECT_EQ(cell.occupied, 0) << z;
      if ((col + 1) * 0.05 < std::min(leaves_m, 2.9)) {
        EXPECT_GT(cell.empty, 0) << z << " column " << col;
      } else if (col * 0.05 > leaves_m) {
        EXPECT_EQ(cell.confidence, 0) << z << " column " << col;
      }
    }
  }
}

TEST(LocalMap, AHeadOutsideTheBandSeesFromWhereItsRaysEnter) {
  const FlogOptions options = paper_band();
  // From 3 m down to 1 m over 4 m: below 2 m after the first half.
  const FlogGrid grid = grid_of(options, {0, 0.02, 3}, {{{4, 0.02, 1}, 0.02, 1}});
  EXPECT_EQ(grid.cell(38, 0, band_of(options)).confidence, 0);
  EXPECT_GT(grid.cell(41, 0, band_of(options)).empty, 0);
  EXPECT_GT(grid.cell(79, 0, band_of(options)).occupied, 0);
  // Level above the band: nothing at all.
  EXPECT_EQ(grid_of(options, {0, 0.02, 3}, {{{4, 0.02, 3}, 0.02, 1}}).map().geometry.cells(), 0U);
}

TEST(LocalMap, FarOrUntrustedPointsAreLeftOut) {
  FlogOptions options = paper_band();
  options.max_range_m = 5;
  EXPECT_EQ(grid_of(options, {0, 0, 0.3}, {{{5.1, 0, 0.3}, 0.1, 1}}).map().geometry.cells(), 0U);
  EXPECT_EQ(grid_of(options, {0, 0, 0.3}, {{{4, 0, 0.3}, 0.1, 0}}).map().geometry.cells(), 0U);
  EXPECT_EQ(grid_of(options, {0, 0, 0.3}, {{{0, 0, 1}, 0.1, 1}}).map().geometry.cells(), 0U)
      << "straight above";
  EXPECT_EQ(grid_of(options, {0, 0, 0.3}, {}).map().geometry.cells(), 0U);
}

TEST(LocalMap, WhereOneRayEndsOthersSpeakLessForEmptiness) {
  FlogOptions options;
  options.layer_heights_m = {0.05, 2.0};
  options.lambda = 0;
  const auto cell_at_edge = [&](bool ends_deny_empty) {
    options.ends_deny_empty = ends_deny_empty;
    return grid_of(options, {0, 0.02, 0.35}, {{{2.025, 0.02, 0.73}, 0.001, 1}, {{4, 0.02, 0.35}, 0.02, 1}})
        .cell(40, 0, 0);
  };
  const FlogCell denied = cell_at_edge(true), plain = cell_at_edge(false);
  EXPECT_GT(plain.empty, 0.4);
  EXPECT_NEAR(denied.empty, plain.empty * (1 - plain.occupied), 1e-6);
  EXPECT_EQ(denied.occupied, plain.occupied);
  EXPECT_EQ(denied.confidence, plain.confidence);
}

TEST(LocalMap, RaysThatStopWhereOthersHaveSweptLeaveNothingOut) {
  // A dense fan of rays, and the same rays in a grid each: every cell that one of them makes free is free.
  FlogOptions options = paper_band();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> side(-1.5, 1.5), ahead(2, 5), up(0.1, 1.9);
  const Eigen::Vector3d head(0.013, 0.021, 0.35);
  std::vector<MapPoint> points;
  for (int i = 0; i < 3000; ++i) points.push_back({{ahead(random), side(random), up(random)}, 0.03, 1});
  const FlogGrid together = grid_of(options, head, points);
  int crossed = 0, left_out = 0;
  for (size_t i = 0; i < points.size(); i += 20) {
    const FlogGrid alone = grid_of(options, head, {points[i]});
    for (int row = -40; row < 40; ++row) {
      for (int col = 0; col < 120; ++col) {
        for (int layer = 0; layer < alone.plane_count(); ++layer) {
          const FlogCell one = alone.cell(col, row, layer), all = together.cell(col, row, layer);
          if (one.confidence == 0) continue;
          ++crossed;
          EXPECT_GE(all.occupied, one.occupied);
          left_out += all.empty < 0.8F * one.empty;  // nearer points weigh a little more
        }
      }
    }
  }
  EXPECT_GT(crossed, 10000);
  EXPECT_LT(left_out, 0.005 * crossed);
}

TEST(MapPointOf, SigmaIsThatOfTheHorizontalDistance) {
  const StereoRig rig = laboratory_rig();
  const Pose T_map_left = Pose(Eigen::Translation3d(1, 2, 0)) * StereoRig::level_camera({0, 0, 0.35});
  // Straight ahead the distance is the depth: sigma_Z = Z^2 sigma_d / (f b).
  const auto ahead = map_point(rig, T_map_left, rig.project({0, 0, 4}), 0.25, 0.7);
  ASSERT_TRUE(ahead);
  EXPECT_LT((ahead->p_map - Eigen::Vector3d(5, 2, 0.35)).norm(), 1e-9);
  EXPECT_NEAR(ahead->sigma_m, 16 * 0.25 / (rig.fx_px * rig.baseline_m), 1e-4);
  EXPECT_EQ(ahead->weight, 0.7);
  // Elsewhere: the spread of the distance over many noisy measurements.
  std::mt19937 random(4);
  std::normal_distribution<double> noise_px(0, 0.25 / std::sqrt(2.0));
  const Eigen::Vector3d uvu = rig.project({-1.5, -1, 3});
  double sum = 0, sum2 = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d noisy(uvu.x() + noise_px(random), uvu.y() + noise_px(random) / std::sqrt(2.0),
                                uvu.z() + noise_px(random));
    const double distance =
        (map_point(rig, T_map_left, noisy, 0.25, 1)->p_map - T_map_left.translation()).head<2>().norm();
    sum += distance, sum2 += distance * distance;
  }
  const double spread = std::sqrt(sum2 / kCount - std::pow(sum / kCount, 2));
  EXPECT_NEAR(map_point(rig, T_map_left, uvu, 0.25, 1)->sigma_m, spread, 0.03 * spread);
  EXPECT_FALSE(map_point(rig, T_map_left, {300, 200, 300}, 0.25, 1));
}

/// One wall across the ray, 60 noisy observations: the numbers that the formulas' author measured.
struct WallCase {
  double distance_m, peak, peak_at_m;
};
class OneWall : public testing::TestWithParam<WallCase> {};

TEST_P(OneWall, PeakFreeSpaceAndUnknownAreAsMeasuredBefore) {
  const FlogOptions options = paper_band();
  const StereoRig rig = laboratory_rig();
  const double fb = rig.fx_px * rig.baseline_m;
  const double d = GetParam().distance_m;
  double peak = 0, at_m = 0;
  constexpr int kSeeds = 20;
  for (int seed = 0; seed < kSeeds; ++seed) {
    FlogGrid grid(options);
    LocalMap local(options, rig);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise_px(0, 0.25);
    for (int i = 0; i < 60; ++i) {
      const double z = fb / (fb / d + noise_px(random));
      const MapPoint point{{z, 0.025, 0.35}, z * z * 0.25 / fb, 1};
      local.add_key_frame({0, 0.025, 0.35}, std::span(&point, 1));
      local.add_to(grid);
    }
    const OccupancyMap map = grid.map();
    const auto highest = std::max_element(map.value.begin(), map.value.end());
    peak += *highest / kSeeds;
    at_m += map.geometry.centre_m(static_cast<int>(highest - map.value.begin()), 0).x() / kSeeds;
    EXPECT_LT(map.at_point(d / 2, 0.025), 0.04);
    EXPECT_EQ(map.at_point(d + 2.5, 0.025), OccupancyMap::kUnknown);
  }
  EXPECT_NEAR(peak, GetParam().peak, 0.01);
  EXPECT_NEAR(at_m, GetParam().peak_at_m, 0.04);
}
INSTANTIATE_TEST_SUITE_P(Distances, OneWall,
                         testing::Values(WallCase{2, 0.983, 2.025}, WallCase{4, 0.979, 4.125},
                                         WallCase{6, 0.900, 6.175}, WallCase{8, 0.718, 8.175}));

}  // namespace
}  // namespace groundloop::slam
