#include "sim/truth/truth_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/sim/truth/scene.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using slam::GridGeometry;
using slam::Pose;
using slam::StereoRig;

TruthWorld truth_of(const Scene& scene, int robot_body = -1) {
  return TruthWorld(*scene.model, *scene.data, robot_body);
}

/// 5 cm cells around the origin, cell borders on multiples of 5 cm.
GridGeometry grid_around_origin(int half_cells = 20) {
  return {0.05, -0.05 * half_cells, -0.05 * half_cells, 2 * half_cells, 2 * half_cells};
}

std::set<std::pair<int, int>> occupied(const slam::OccupancyMap& map) {
  std::set<std::pair<int, int>> cells;
  for (int row = 0; row < map.geometry.rows; ++row) {
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (map.at(col, row) == 1) cells.insert({col, row});
    }
  }
  return cells;
}

/// The cells for which `inside` holds of (low corner, high corner).
template <class Inside>
std::set<std::pair<int, int>> cells_where(const GridGeometry& grid, const Inside& inside) {
  std::set<std::pair<int, int>> cells;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const Vector2d low(grid.x_min_m + col * grid.cell_m, grid.y_min_m + row * grid.cell_m);
      if (inside(low, Vector2d(low + Vector2d::Constant(grid.cell_m)))) cells.insert({col, row});
    }
  }
  return cells;
}

StereoRig small_rig() { return slam::centred_rig(64, 48, 60, 0.1); }

const char* const kEveryShape =
    "<geom name='floor' type='plane' size='0 0 1'/>"
    "<geom name='wall' type='box' size='0.1 3 1.5' pos='4 0 1.5'/>"
    "<geom name='desk' type='box' size='0.6 0.4 0.02' pos='1 1 0.7' euler='0 0 30'/>"
    "<geom name='crate' type='box' size='0.3 0.2 0.25' pos='2 -1 0.4' euler='20 30 40'/>"
    "<geom name='ball' type='sphere' size='0.3' pos='-1 1 0.4'/>"
    "<geom name='pipe' type='capsule' size='0.1 0.5' pos='-1 -1 0.7' euler='30 60 0'/>"
    "<geom name='tin' type='cylinder' size='0.25 0.4' pos='-2 0.5 0.6' euler='70 10 0'/>"
    "<geom name='egg' type='ellipsoid' size='0.2 0.4 0.6' pos='0 -2 0.7' euler='10 20 30'/>"
    "<geom name='tent' type='mesh' mesh='pyramid' pos='1 2.5 0.1' euler='0 15 0'/>";

// MuJoCo's ray caster is an implementation of its own, over the same model.
TEST(Cast, AgreesWithMuJoCoOnEveryShape) {
  const Scene scene(kEveryShape, kPyramidAsset);
  const TruthWorld truth = truth_of(scene);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> in(-1, 1);
  std::set<int> seen;
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d origin(3.5 * in(random), 3.5 * in(random), 2.5 + 0.9 * in(random));
    const Vector3d target(3.5 * in(random), 3.5 * in(random), 0.5 + 0.5 * in(random));
    const Vector3d direction = (target - origin).normalized();
    int geom = -1;
    const double wanted =
        mj_ray(scene.model.get(), scene.data.get(), origin.data(), direction.data(), nullptr, 1, -1, &geom);
    const auto hit = truth.cast(origin, direction, 50);
    ASSERT_EQ(hit.has_value(), wanted >= 0 && wanted <= 50);
    if (!hit) continue;
    ++hits;
    seen.insert(hit->geom);
    ASSERT_NEAR(hit->distance_m, wanted, 1e-6)
        << truth.geom_name(hit->geom) << " / " << truth.geom_name(geom);
    ASSERT_EQ(hit->geom, geom);
    ASSERT_NEAR((hit->p_world - origin - wanted * direction).norm(), 0, 1e-6);
    ASSERT_LE(hit->normal_world.dot(direction), 0);
    ASSERT_NEAR(hit->normal_world.norm(), 1, 1e-12);
  }
  EXPECT_GT(hits, 10000);
  EXPECT_EQ(seen.size(), static_cast<size_t>(scene.model->ngeom));
}

// MuJoCo's ray caster is exact on a height field from above; beside it, it also hits points above the
// surface.
TEST(Cast, HeightFieldIsItsTrianglesAndItsSkirt) {
  const Scene scene("<geom type='hfield' hfield='hill' pos='0.3 0.2 0.1'/>",
                    "<hfield name='hill' nrow='6' ncol='9' size='1 0.8 0.5 0.2'/>");
  float* data = scene.model->hfield_data;
  for (int i = 0; i < scene.model->nhfielddata; ++i)
    data[i] = static_cast<float>(0.5 + 0.5 * std::sin(1.7 * i));
  const TruthWorld truth = truth_of(scene);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> in(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin(0.3 + 0.999 * in(random), 0.2 + 0.799 * in(random), 3), down(0, 0, -1);
    int geom = -1;
    const double wanted =
        mj_ray(scene.model.get(), scene.data.get(), origin.data(), down.data(), nullptr, 1, -1, &geom);
    const auto hit = truth.cast(origin, down, 10);
    ASSERT_TRUE(hit);
    ASSERT_NEAR(hit->distance_m, wanted, 1e-6);
  }
  // side x = -1 between rows 2 and 3 (y = -0.16 and 0.16): the skirt ends on the line between the heights
  // there
  const double edge_z = 0.1 + 0.5 * (0.75 * data[2 * 9] + 0.25 * data[3 * 9]);
  const double y = 0.2 - 0.08;
  const auto below = truth.cast({-5, y, edge_z - 1e-4}, {1, 0, 0}, 10);
  ASSERT_TRUE(below);
  EXPECT_NEAR(below->p_world.x(), -0.7, 1e-12);
  EXPECT_NEAR((below->normal_world - Vector3d(-1, 0, 0)).norm(), 0, 1e-12);
  const auto above = truth.cast({-5, y, edge_z + 1e-3}, {1, 0, 0}, 10);
  ASSERT_TRUE(above);
  EXPECT_GT(above->p_world.x(), -0.7 + 1e-4);
  EXPECT_NEAR(truth.cast({0.31, 0.22, -5}, {0, 0, 1}, 10)->distance_m, 4.9, 1e-12);  // base at 0.1 - 0.2
}

TEST(Cast, DirectionNeedNotBeOfUnitLength) {
  const Scene scene("<geom type='box' size='0.5 1 1' pos='3 0 0'/>");
  const TruthWorld truth = truth_of(scene);
  const auto hit = truth.cast({0, 0.2, 0.3}, {7, 0, 0}, 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 2.5, 1e-12);
  EXPECT_NEAR((hit->p_world - Vector3d(2.5, 0.2, 0.3)).norm(), 0, 1e-12);
  EXPECT_EQ(hit->normal_world, Vector3d(-1, 0, 0));
  EXPECT_FALSE(truth.cast({0, 0, 0}, {7, 0, 0}, 2.4));
}

TEST(Cast, OnlyVisibleGeomsCount) {
  const Scene scene(
      "<geom type='box' size='.1 1 1' pos='1 0 0' group='3'/>"
      "<geom type='box' size='.1 1 1' pos='2 0 0' rgba='1 0 0 0'/>"
      "<geom type='box' size='.1 1 1' pos='3 0 0' material='glass'/>"
      "<geom name='seen' type='box' size='.1 1 1' pos='4 0 0' group='2'/>",
      "<material name='glass' rgba='1 1 1 0'/>");
  const TruthWorld truth = truth_of(scene);
  const auto hit = truth.cast({0, 0, 0}, {1, 0, 0}, 100);
  ASSERT_TRUE(hit);
  EXPECT_EQ(truth.geom_name(hit->geom), "seen");
  EXPECT_NEAR(hit->distance_m, 3.9, 1e-12);
}

TEST(Cast, RobotIsNotPartOfTheScene) {
  const Scene scene(
      "<body name='robot'><freejoint/><geom type='sphere' size='.2'/>"
      "<body name='mast' pos='1 0 0'><geom type='box' size='.1 1 1'/></body></body>"
      "<geom name='wall' type='box' size='.1 1 1' pos='4 0 0'/>");
  const auto hit = truth_of(scene, scene.body("robot")).cast({0.5, 0, 0}, {1, 0, 0}, 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 3.4, 1e-12);
  EXPECT_NEAR(truth_of(scene).cast({0.5, 0, 0}, {1, 0, 0}, 100)->distance_m, 0.4, 1e-12);
}

TEST(Cast, StateWithoutPositionsIsRefused) {
  Scene scene("<geom type='box' size='.1 1 1'/>");
  mju_zero(scene.data->geom_xmat, 9);
  EXPECT_THROW(truth_of(scene), std::invalid_argument);
}

TEST(GeomName, UnnamedGeomsSayWhereTheyBelong) {
  const Scene scene(
      "<geom name='floor' type='plane' size='1 1 1'/><body name='desk'><geom type='sphere' size='.1'/></body>"
      "<body><geom type='sphere' size='.1'/></body>");
  const TruthWorld truth = truth_of(scene);
  EXPECT_EQ(truth.geom_name(0), "floor");
  EXPECT_EQ(truth.geom_name(1), "geom 1 (body desk)");
  EXPECT_EQ(truth.geom_name(2), "geom 2 (body body 2)");
}

TEST(Depth, IsTakenAlongTheOpticalAxis) {
  const Scene scene("<geom type='box' size='0.5 10 10' pos='3.5 0 0'/>");
  const TruthWorld truth = truth_of(scene);
  Pose T_world_left = StereoRig::level_camera({0.5, 0.1, 1});
  for (const double u_px : {0.0, 20.0, 31.5, 63.0}) {
    for (const double v_px : {0.0, 23.5, 47.0}) {
      const auto depth_m = truth.depth_m(small_rig(), T_world_left, u_px, v_px);
      ASSERT_TRUE(depth_m);
      EXPECT_NEAR(*depth_m, 2.5, 1e-12);
    }
  }
  EXPECT_FALSE(truth.depth_m(small_rig(), T_world_left, 31.5, 23.5, 2.4));
  // turned by 30 degrees: the ray of column u meets x = 2.5 at depth z with z cos 30 - (u - cx)/f z sin(-30)
  // = 2.5
  const double turn_rad = M_PI / 6;
  T_world_left.linear() =
      Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()).toRotationMatrix() * T_world_left.linear();
  const double x = (50 - 31.5) / 60;
  EXPECT_NEAR(*truth.depth_m(small_rig(), T_world_left, 50, 10),
              2.5 / (std::cos(turn_rad) + x * std::sin(turn_rad)), 1e-12);
}

TEST(Occupancy, BoxOnCellBordersFillsExactlyItsCells) {
  const Scene scene("<geom type='box' size='0.15 0.1 0.5' pos='0.15 0.1 0.5'/>");
  const auto map = truth_of(scene).occupancy(grid_around_origin(), 0.02, 2);
  EXPECT_EQ(occupied(map), cells_where(map.geometry, [](const Vector2d& low, const Vector2d& high) {
              return low.x() > -0.01 && high.x() < 0.31 && low.y() > -0.01 && high.y() < 0.21;
            }));
  EXPECT_EQ(occupied(map).size(), 6U * 4U);
}

TEST(Occupancy, BoxAcrossCellBordersFillsEveryCellItReaches) {
  const Scene scene("<geom type='box' size='0.15 0.1 0.5' pos='0.16 0.11 0.5'/>");
  EXPECT_EQ(occupied(truth_of(scene).occupancy(grid_around_origin(), 0.02, 2)).size(), 7U * 5U);
}

TEST(Occupancy, HeightBandDecides) {
  const Scene scene(
      "<geom type='plane' size='0 0 1'/>"
      "<geom type='box' size='0.15 0.1 0.01' pos='0.15 0.1 0.7'/>");
  const TruthWorld truth = truth_of(scene);
  const GridGeometry grid = grid_around_origin();
  EXPECT_EQ(occupied(truth.occupancy(grid, 0.02, 2)).size(), 24U);
  EXPECT_EQ(occupied(truth.occupancy(grid, 0.02, 0.69)).size(), 0U);  // touches from above
  EXPECT_EQ(occupied(truth.occupancy(grid, 0.71, 2)).size(), 0U);     // touches from below
  EXPECT_EQ(occupied(truth.occupancy(grid, 0.02, 0.691)).size(), 24U);
  EXPECT_EQ(occupied(truth.occupancy(grid, -0.1, 0.1)).size(), grid.cells());  // takes in the floor
}

TEST(Occupancy, RoundBodiesFillTheCellsWithinTheirRadius) {
  const Vector2d centre(0.013, -0.021);
  const auto within = [&](double radius) {
    return [=](const Vector2d& low, const Vector2d& high) {
      const Vector2d nearest = centre.cwiseMax(low).cwiseMin(high);
      return (nearest - centre).norm() < radius;
    };
  };
  const GridGeometry grid = grid_around_origin();
  const auto fills = [&](const std::string& geom) {
    const Scene scene("<geom pos='0.013 -0.021 1' " + geom + "/>");
    return occupied(truth_of(scene).occupancy(grid, 0.02, 2));
  };
  EXPECT_EQ(fills("type='sphere' size='0.4'"), cells_where(grid, within(0.4)));
  EXPECT_EQ(fills("type='cylinder' size='0.4 0.3'"), cells_where(grid, within(0.4)));
  EXPECT_EQ(fills("type='capsule' size='0.4 0.3'"), cells_where(grid, within(0.4)));
  EXPECT_EQ(fills("type='ellipsoid' size='0.4 0.4 0.7'"), cells_where(grid, within(0.4)));
}

TEST(Occupancy, SphereIsCutByTheHeightBand) {
  const Vector2d centre(0.013, -0.021);
  const Scene scene("<geom pos='0.013 -0.021 1' type='sphere' size='0.5'/>");
  // the band ends 0.3 below the centre: radius 0.4 there
  const GridGeometry grid = grid_around_origin();
  EXPECT_EQ(occupied(truth_of(scene).occupancy(grid, 0.02, 0.7)),
            cells_where(grid, [&](const Vector2d& low, const Vector2d& high) {
              return (centre.cwiseMax(low).cwiseMin(high) - centre).norm() < 0.4;
            }));
}

TEST(Occupancy, TurnedBoxFillsTheCellsOfTheTurnedSquare) {
  const Scene scene("<geom type='box' size='0.3 0.3 0.5' pos='0 0 0.5' euler='0 0 45'/>");
  // |x| + |y| < 0.3 sqrt 2: the corner of the cell nearest to the origin decides
  const GridGeometry grid = grid_around_origin();
  EXPECT_EQ(occupied(truth_of(scene).occupancy(grid, 0.02, 2)),
            cells_where(grid, [](const Vector2d& low, const Vector2d& high) {
              return Vector2d::Zero().cwiseMax(low).cwiseMin(high).lpNorm<1>() < 0.3 * std::sqrt(2.0);
            }));
}

TEST(Occupancy, MeshFillsTheCellsUnderItsSurface) {
  // the band cuts the pyramid between heights 0.3 and 0.6 of its own: a frame between |p|max = 0.8 and 0.6
  const Scene scene("<geom type='mesh' mesh='pyramid'/>", kPyramidAsset);
  const TruthWorld truth = truth_of(scene);
  // MuJoCo moves a mesh to its centre of mass, and the geom back
  EXPECT_NEAR(truth.cast({0, 0, 5}, {0, 0, -1}, 10)->p_world.z(), 1.5, 1e-6);
  const GridGeometry grid{0.05, -1.02, -1.02, 41, 41};
  EXPECT_EQ(occupied(truth.occupancy(grid, 0.3, 0.6)),
            cells_where(grid, [](const Vector2d& low, const Vector2d& high) {
              const double nearest = Vector2d::Zero().cwiseMax(low).cwiseMin(high).lpNorm<Eigen::Infinity>();
              const double farthest = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
              return nearest < 0.8 && farthest > 0.6;
            }));
}

TEST(Bounds, CoverBoundedGeometryWithOneCellAround) {
  const Scene scene(
      "<geom type='plane' size='0 0 1'/><geom type='plane' size='2 0 1'/>"
      "<geom type='box' size='1 0.5 1' pos='0.52 0 0'/><geom type='sphere' size='0.25' pos='0 1 0'/>");
  const GridGeometry grid = truth_of(scene).bounds(0.05);
  EXPECT_NEAR(grid.x_min_m, -0.55, 1e-12);  // -0.48 -> -0.5, one cell more
  EXPECT_NEAR(grid.y_min_m, -0.55, 1e-12);
  EXPECT_NEAR(grid.x_min_m + grid.cols * 0.05, 1.60, 1e-9);  // 1.52 -> 1.55, one cell more
  EXPECT_NEAR(grid.y_min_m + grid.rows * 0.05, 1.30, 1e-9);
  EXPECT_EQ(truth_of(Scene("<geom type='plane' size='0 0 1'/>")).bounds(0.05).cells(), 0U);
}

/// A camera at the origin, 1 m up, looks along x at a wall face 2 m away that spans |y| <= 0.5.
class VisibleCells : public testing::Test {
 protected:
  static constexpr double kFace_m = 2.0;
  static Pose look_up() {  // by 20 degrees: the image reaches from 0 to 41 degrees
    Pose T_world_left = StereoRig::level_camera({0, 0, 1});
    T_world_left.linear() *= Eigen::AngleAxisd(20 * M_PI / 180, Vector3d::UnitX()).toRotationMatrix();
    return T_world_left;
  }
  Scene scene_{"<geom type='plane' size='0 0 1'/><geom type='box' size='0.1 0.5 1' pos='2.1 0 1'/>"};
  TruthWorld truth_ = truth_of(scene_);
  GridGeometry grid_{0.05, -1, -3, 120, 120};
  double max_range_m_ = 3.5;
  std::vector<uint8_t> seen_ =
      truth_.visible_cells(grid_, small_rig(), {StereoRig::level_camera({0, 0, 1})}, 0.02, 2, max_range_m_);
  int seen(double x_m, double y_m) const { return seen_[grid_.index(grid_.col_of(x_m), grid_.row_of(y_m))]; }
};

TEST_F(VisibleCells, EverythingInTheWedgeUpToTheWallAndNothingBehind) {
  // edges of the image's rays: outermost tile centres are 0.25 px inside the image border at 32 px
  const double slope = (32 - 0.25) / 60;
  for (int row = 0; row < grid_.rows; ++row) {
    for (int col = 0; col < grid_.cols; ++col) {
      const Vector2d c = grid_.centre_m(col, row);
      const bool is_seen = seen_[grid_.index(col, row)] != 0;
      const double h = 0.05;
      // cells wholly outside the field of view, or of range, or wholly in the wall's shadow
      if (c.x() < -h || std::abs(c.y()) > slope * c.x() + 2 * h || c.norm() > max_range_m_ + h) {
        EXPECT_FALSE(is_seen) << c.transpose();
      }
      const double face_slope = 0.5 / kFace_m;
      if (c.x() > kFace_m + h && std::abs(c.y()) < face_slope * c.x() - 2 * h) {
        EXPECT_FALSE(is_seen) << c.transpose();
      }
      // cells well inside the open wedge
      if (c.x() > h && c.x() < kFace_m && std::abs(c.y()) < slope * c.x() - h) {
        EXPECT_TRUE(is_seen) << c.transpose();
      }
    }
  }
}

TEST_F(VisibleCells, SurfaceCellOfTheWallIsSeen) {
  // the face lies on a border of cells; the wall's own cells are those behind it
  for (double y_m = -0.475; y_m < 0.5; y_m += 0.05) EXPECT_EQ(seen(kFace_m + 0.025, y_m), kFaceSeen) << y_m;
  EXPECT_EQ(seen(kFace_m + 0.075, 0), kUnseen);
  EXPECT_EQ(seen(kFace_m - 0.025, 0), kCrossed);
}

TEST_F(VisibleCells, UndersideOfATopIsCrossedItsEdgeIsAFace) {
  const Scene scene("<geom type='box' size='0.5 2 0.1' pos='1.5 0 1.6'/>");  // 0.5 m above the camera
  const auto sight = truth_of(scene).visible_cells(grid_, small_rig(), {look_up()}, 0.02, 2, 6);
  const auto at = [&](double x_m) { return sight[grid_.index(grid_.col_of(x_m), grid_.row_of(0.025))]; };
  EXPECT_EQ(at(1.025), kFaceSeen);  // the front edge, at 27 to 35 degrees
  for (double x_m = 1.075; x_m < 2; x_m += 0.05) EXPECT_EQ(at(x_m), kCrossed) << x_m;
}

TEST_F(VisibleCells, HeightBandCutsTheRays) {
  // the rays fall to the floor by at most 23.5/60 a metre: below 0.2 m nothing is seen before 0.8 / (23.5/60)
  // = 2.04 m
  const auto low =
      truth_.visible_cells(grid_, small_rig(), {StereoRig::level_camera({0, 0, 1})}, 0.02, 0.2, 6);
  for (int row = 0; row < grid_.rows; ++row) {
    for (int col = 0; col < grid_.col_of(1.9); ++col) EXPECT_EQ(low[grid_.index(col, row)], 0);
  }
  EXPECT_EQ(low[grid_.index(grid_.col_of(2.525), grid_.row_of(0.9))], 1);
}

/// A robot with a box body of 0.4 x 0.3 m on a wheel, and a mast of radius 0.05 at its nose, 0.5 m high.
class Collision : public testing::Test {
 protected:
  std::string text(double x_m, double y_m, double yaw_rad = 0, double margin_m = 0) const {
    return truth_.collision(x_m, y_m, yaw_rad, margin_m).value_or("none");
  }
  Scene scene_{
      "<geom name='floor' type='plane' size='0 0 1'/>"
      "<body name='robot'><freejoint/><geom type='box' size='0.2 0.15 0.1' pos='0 0 0.15'/>"
      "<geom type='sphere' size='0.05' pos='0 0 0.05'/>"
      "<geom type='cylinder' size='0.05 0.2' pos='0.15 0 0.3'/></body>"
      "<body name='desk'><geom type='box' size='0.5 0.5 0.02' pos='3 0 0.6'/>"
      "<geom name='leg' type='box' size='0.02 0.02 0.3' pos='3 0.4 0.3'/></body>"
      "<geom name='wall' type='box' size='0.1 5 1' pos='-3 0 1'/>"
      "<geom name='bin' type='cylinder' size='0.3 0.2' pos='0 3 0.2'/>"
      "<geom name='tent' type='mesh' mesh='pyramid' pos='0 -4 0'/>"
      "<geom name='sill' type='box' size='1 1 0.009' pos='6 0 0.009'/>",
      kPyramidAsset};
  TruthWorld truth_{*scene_.model, *scene_.data, scene_.body("robot")};
};

TEST_F(Collision, FaceToFace) {
  EXPECT_EQ(text(-2.7 + 1e-5, 0), "none");
  EXPECT_EQ(text(-2.7 - 1e-5, 0), "wall");
  EXPECT_EQ(text(-2.6 + 1e-5, 0, 0, 0.1), "none");  // margin
  EXPECT_EQ(text(-2.6 - 1e-5, 0, 0, 0.1), "wall");
  EXPECT_EQ(text(-2.75 + 1e-5, 0, M_PI / 2), "none");  // turned: half width 0.15
  EXPECT_EQ(text(-2.75 - 1e-5, 0, M_PI / 2), "wall");
  const double corner = 0.25 * std::cos(M_PI / 4 - std::atan2(0.15, 0.2));  // turned by 45 degrees
  EXPECT_EQ(text(-2.9 + corner + 1e-5, 0, M_PI / 4), "none");
  EXPECT_EQ(text(-2.9 + corner - 1e-5, 0, M_PI / 4), "wall");
}

TEST_F(Collision, RoundObstacleAndRoundMargin) {
  EXPECT_EQ(text(0, 3 - 0.45 - 1e-5), "none");
  EXPECT_EQ(text(0, 3 - 0.45 + 1e-5), "bin");
  // corner of the body on the diagonal from the bin's axis, with a margin of 0.1: distance 0.3 + 0.1
  const double away = 0.4 / std::sqrt(2.0);
  EXPECT_EQ(text(0.2 + away + 1e-5, 3 + 0.15 + away), "none");
  EXPECT_EQ(text(0.2 + away + 1e-5, 3 + 0.15 + away, 0, 0.1), "none");
  EXPECT_EQ(text(0.2 + away - 2e-5, 3 + 0.15 + away, 0, 0.1), "bin");
}

TEST_F(Collision, HeightDecides) {
  EXPECT_EQ(text(3, 0), "none");  // the mast ends at 0.5, the desk top starts at 0.58
  EXPECT_EQ(text(3, 0.3), "leg");
  EXPECT_EQ(text(6, 0), "none");  // a sill of 18 mm can be driven over
}

TEST_F(Collision, EveryPartIsSweptOverTheWholeHeight) {
  // the mesh slopes by 1.5 m a metre; at z = 0.02 it reaches to |y| = 1 - 0.02/1.5
  const double reach = 1 - 0.02 / 1.5;
  EXPECT_EQ(text(0, -4 + reach + 0.15 + 1e-4), "none");
  EXPECT_EQ(text(0, -4 + reach + 0.15 - 1e-4), "tent");
}

TEST_F(Collision, UnnamedGeomIsNamedByItsBody) {
  const Scene scene(
      "<body name='robot'><freejoint/><geom type='box' size='0.2 0.2 0.2' pos='0 0 0.2'/></body>"
      "<body name='desk' pos='1 0 0'><geom type='box' size='0.1 0.1 1'/></body>");
  EXPECT_EQ(truth_of(scene, scene.body("robot")).collision(1, 0, 0, 0), "geom 1 (body desk)");
}

// A round robot and round obstacles: the distance at which they touch is the sum of the radii from every
// side.
TEST(CollisionOfRoundBodies, IsExactToAMicrometreFromEverySide) {
  const Scene scene(
      "<body name='robot'><freejoint/><geom type='cylinder' size='0.25 0.2' pos='0 0 0.2'/></body>"
      "<geom name='tin' type='cylinder' size='0.3 0.2' pos='0 0 0.2'/>"
      "<geom name='ball' type='sphere' size='0.3' pos='10 0 0.3'/>"
      "<geom name='egg' type='ellipsoid' size='0.3 0.3 0.5' pos='20 0 0.35'/>"
      "<geom name='pill' type='capsule' size='0.3 0.2' pos='30 0 0.4'/>");
  const TruthWorld truth = truth_of(scene, scene.body("robot"));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double angle = M_PI * in(random), margin_m = 0.1 + 0.1 * in(random), yaw_rad = 3 * in(random);
    const double x_m = 10 * (i % 4);
    const auto at = [&](double distance_m) {
      return truth.collision(x_m + distance_m * std::cos(angle), distance_m * std::sin(angle), yaw_rad,
                             margin_m);
    };
    EXPECT_FALSE(at(0.55 + margin_m + 1e-6));
    EXPECT_EQ(at(0.55 + margin_m - 1e-6), truth.geom_name(i % 4));
  }
}

TEST(Footprints, AreSeenFromAbove) {
  const Scene scene(
      "<geom type='plane' size='0 0 1'/><geom name='lamp' type='box' size='1 1 .1' pos='0 0 2.5'/>"
      "<body name='desk'><geom name='top' type='box' size='0.3 0.2 0.02' pos='1 2 0.7'/></body>"
      "<geom name='tin' type='cylinder' size='0.5 0.3' pos='0 0 0.3'/>");
  const auto outlines = truth_of(scene).footprints(0.02, 2);
  ASSERT_EQ(outlines.size(), 2U);
  EXPECT_EQ(outlines[0].name, "tin");
  EXPECT_EQ(outlines[1].name, "top");
  EXPECT_EQ(outlines[1].body, "desk");
  EXPECT_NEAR(outlines[1].z_max_m, 0.72, 1e-12);
  ASSERT_EQ(outlines[1].polygon.size(), 4U);
  EXPECT_THAT(outlines[1].polygon, testing::Each(testing::Truly([](const Vector2d& p) {
                return std::abs(std::abs(p.x() - 1) - 0.3) < 1e-12 &&
                       std::abs(std::abs(p.y() - 2) - 0.2) < 1e-12;
              })));
  ASSERT_EQ(outlines[0].polygon.size(), 64U);
  for (const Vector2d& p : outlines[0].polygon) EXPECT_NEAR(p.norm(), 0.5, 1e-12);
}

}  // namespace
}  // namespace groundloop::sim
