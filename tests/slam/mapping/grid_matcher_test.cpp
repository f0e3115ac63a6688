#include "slam/mapping/grid_matcher.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "slam/types/counter_random.h"
#include "tests/slam/mapping/drawn_map.h"
#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double uniform(uint64_t stream, uint64_t i) {
  return static_cast<double>(random_bits(5, stream, i) >> 11) * 0x1.0p-53 * 2 - 1;
}

/// Error (x, y, yaw) of a match in the local frame.
Eigen::Vector3d error(const MapMatch& match, const Eigen::Isometry2d& T_global_local) {
  const Eigen::Isometry2d E = match.pose.T_global_local.inverse() * T_global_local;
  return {E.translation().x(), E.translation().y(), Eigen::Rotation2Dd(E.linear()).angle()};
}

PlanarPose prior_at(const Eigen::Isometry2d& T_global_local, double sigma_m, double sigma_deg) {
  PlanarPose prior;
  prior.T_global_local = T_global_local;
  const double yaw_rad = sigma_deg * kDegree;
  prior.covariance = Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, yaw_rad * yaw_rad).asDiagonal();
  return prior;
}

/// Part of a furnished room: two walls, a cupboard, a pillar.
std::vector<PlanRectangle> corner_of_a_room() {
  return {{{-0.11, -0.11}, {5, 0}},
          {{-0.11, 0}, {0, 4}},
          {{1.3, 0}, {2.2, 0.45}},
          {{2.9, 2.1}, {3.3, 2.4}},
          {{0.0, 2.6}, {0.55, 3.1}}};
}
const GridGeometry kGlobal{0.05, -2.03, -2.01, 180, 150};
const GridGeometry kLocal{0.05, -4.51, -4.02, 200, 180};

TEST(GridMatcher, FindsAKnownShiftWithinAThirdOfACell) {
  const OccupancyMap global = drawn_map(corner_of_a_room(), planar(0, 0, 0), kGlobal);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Isometry2d truth =
        planar(2 + uniform(0, i), 2 + uniform(1, i), i * 0.7);  // the local frame looks anywhere
    const OccupancyMap local = drawn_map(corner_of_a_room(), truth.inverse(), kLocal);
    const Eigen::Isometry2d off = planar(0.3 * uniform(2, i), 0.3 * uniform(3, i), 0.1 * uniform(4, i));
    const MapMatch match = match_maps(global, local, prior_at(truth * off, 0.2, 4), MapMatchOptions{});
    EXPECT_TRUE(match.accepted) << match.message;
    EXPECT_LT(error(match, truth).head<2>().norm(), 0.05 / 3);
    EXPECT_LT(std::abs(error(match, truth).z()), 0.2 * kDegree);
    EXPECT_NEAR(match.score, 1, 0.1);
    EXPECT_GT(match.overlap, 0.95);
    EXPECT_GT(match.agreement, 0.95);
  }
}

TEST(GridMatcher, AStraightCorridorLeavesTheWayAlongItOpen) {
  const std::vector<PlanRectangle> corridor = {{{-50, -1.1}, {50, -1}}, {{-50, 1}, {50, 1.1}}};
  const OccupancyMap global = drawn_map(corridor, planar(0, 0, 0), {0.05, -6, -2, 240, 80});
  const Eigen::Isometry2d truth = planar(0.4, 0.1, 0.5);
  GridGeometry near{0.05, -2, -2, 80, 80};
  const OccupancyMap local = drawn_map(corridor, truth.inverse(), near);
  const Eigen::Isometry2d off = planar(0, 0.12, 0.03);
  const MapMatch match = match_maps(global, local, prior_at(truth * off, 0.15, 3), MapMatchOptions{});
  EXPECT_FALSE(match.accepted);
  EXPECT_NE(match.message.find("not enough structure"), std::string::npos) << match.message;

  // What is fixed is fixed, and the covariance is long along the corridor only.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(match.pose.covariance.topLeftCorner<2, 2>());
  EXPECT_GT(std::sqrt(axes.eigenvalues()[1]), 0.1);
  EXPECT_LT(std::sqrt(axes.eigenvalues()[0]), 0.025);
  EXPECT_GT(std::abs(axes.eigenvectors().col(1).dot(truth.linear().transpose().col(0))), 0.99);
  const Eigen::Vector3d e = error(match, truth);
  const Eigen::Vector2d across_local = truth.linear().transpose().col(1);
  EXPECT_LT(std::abs(across_local.dot(e.head<2>())), 0.05 / 3);
  EXPECT_LT(std::abs(e.z()), 0.2 * kDegree);
}

TEST(GridMatcher, RepeatedThingsAreAmbiguous) {
  // Seven equal pillars in a row, 0.45 m apart; the local map sees three of the inner ones.
  std::vector<PlanRectangle> row, three;
  for (int i = 0; i < 7; ++i) {
    row.push_back({{0.45 * i, 0}, {0.45 * i + 0.2, 0.25}});
    if (i >= 2 && i < 5) three.push_back(row.back());
  }
  const OccupancyMap global = drawn_map(row, planar(0, 0, 0), {0.05, -2, -2, 160, 90});
  const OccupancyMap local = drawn_map(three, planar(0, 0, 0), {0.05, -2, -2, 160, 90});
  MapMatchOptions options;
  options.min_cells = 20;
  const MapMatch match = match_maps(global, local, prior_at(planar(0, 0, 0), 0.2, 2), options);
  EXPECT_FALSE(match.accepted);
  EXPECT_GT(match.second_score, 0.9);
  EXPECT_NE(match.message.find("another place fits"), std::string::npos) << match.message;

  // Known well enough before, only one of them is possible.
  EXPECT_EQ(match_maps(global, local, prior_at(planar(0, 0, 0), 0.05, 2), options).second_score, 0);
}

TEST(GridMatcher, TooLittleIsNotEnoughStructure) {
  const OccupancyMap room = drawn_map(corner_of_a_room(), planar(0, 0, 0), kGlobal);
  const OccupancyMap empty = drawn_map({}, planar(0, 0, 0), kGlobal);
  OccupancyMap unknown = empty;
  unknown.value.assign(unknown.value.size(), OccupancyMap::kUnknown);
  const PlanarPose prior = prior_at(planar(0, 0, 0), 0.1, 2);
  const MapMatchOptions options;
  const auto message = [&](const OccupancyMap& global, const OccupancyMap& local) {
    const MapMatch match = match_maps(global, local, prior, options);
    EXPECT_FALSE(match.accepted);
    return match.message;
  };
  EXPECT_EQ(message(room, empty), "not enough structure: 0 occupied cells, 80 are needed");
  EXPECT_EQ(message(room, OccupancyMap{}), "not enough structure: 0 occupied cells, 80 are needed");
  EXPECT_EQ(message(unknown, room), "not enough structure: nothing of the global map is occupied there");
  EXPECT_EQ(message(OccupancyMap{{0.05, 0, 0, 0, 0}, {}}, room),
            "not enough structure: nothing of the global map is occupied there");

  // The global map knows a small part of what the local one shows.
  OccupancyMap part = room;
  for (int row = 0; row < kGlobal.rows; ++row) {
    for (int col = 0; col < kGlobal.cols; ++col) {
      if (kGlobal.centre_m(col, row).x() > 1) part.value[kGlobal.index(col, row)] = OccupancyMap::kUnknown;
    }
  }
  EXPECT_NE(message(part, room).find("the global map knows"), std::string::npos);
}

TEST(GridMatcher, AnotherRoomIsRefused) {
  const OccupancyMap global = drawn_map(corner_of_a_room(), planar(0, 0, 0), kGlobal);
  const std::vector<PlanRectangle> other = {
      {{0.4, 0.6}, {3.1, 0.7}}, {{3, 1}, {3.1, 3.3}}, {{1, 1.7}, {1.3, 2.2}}};
  const MapMatch match = match_maps(global, drawn_map(other, planar(0, 0, 0), kGlobal),
                                    prior_at(planar(0, 0, 0), 0.1, 2), MapMatchOptions{});
  EXPECT_FALSE(match.accepted);
  EXPECT_NE(match.message.find("the maps disagree"), std::string::npos) << match.message;
}

TEST(GridMatcher, ABestPlaceAtTheEdgeIsRefused) {
  const OccupancyMap global = drawn_map(corner_of_a_room(), planar(0, 0, 0), kGlobal);
  const Eigen::Isometry2d truth = planar(2, 2, 0);
  const OccupancyMap local = drawn_map(corner_of_a_room(), truth.inverse(), kLocal);
  const PlanarPose prior = prior_at(truth * planar(0.27, 0, 0), 0.2, 2);
  MapMatchOptions options;
  options.max_window_m = 0.15;
  EXPECT_EQ(match_maps(global, local, prior, options).message,
            "the best place is at the edge of the search window");
  options.max_window_m = 0.3;
  EXPECT_TRUE(match_maps(global, local, prior, options).accepted);
}

/// FLOG map of the laboratory, measured with noise from true poses.
/// @param T_map_world  the frame the map is made in
OccupancyMap measured_map(const std::vector<Pose>& T_world_left, const Pose& T_map_world, uint64_t seed) {
  const RoomWorld world = RoomWorld::laboratory();
  const StereoRig rig = laboratory_rig();
  FlogOptions options;  // of a head that measures no better than this
  options.layer_heights_m = {0.05, 0.5, 1.0, 1.5, 2.0};
  options.ends_deny_empty = false;
  options.k_empty = 0.4;
  options.sigma_disparity_px = 0.25, options.sigma_max_m = 0.30;
  FlogGrid grid(options);
  LocalMap local(options, rig);
  for (size_t i = 0; i < T_world_left.size(); ++i) {
    auto points = measure(world, rig, T_world_left[i], 400, 0.25, 1000 * seed + i);
    for (MapPoint& point : points) point.p_map = T_map_world * point.p_map;
    local.add_key_frame(T_map_world * T_world_left[i].translation(), points);
    local.add_to(grid);
  }
  return grid.map();
}

/// The last of the poses, as a planar frame of the body.
Eigen::Isometry2d frame_of(const std::vector<Pose>& T_world_left) {
  const Pose& newest = T_world_left.back();
  const Eigen::Vector3d ahead = newest.linear().col(2);
  return planar(newest.translation().x(), newest.translation().y(), std::atan2(ahead.y(), ahead.x()));
}

Pose lifted(const Eigen::Isometry2d& T) {
  Pose pose = Pose::Identity();
  pose.linear().topLeftCorner<2, 2>() = T.linear();
  pose.translation().head<2>() = T.translation();
  return pose;
}

TEST(GridMatcher, CovarianceIsHonestOverMeasuredMaps) {
  const std::vector<Pose> lap = laboratory_lap(48);
  const OccupancyMap global = measured_map(lap, Pose::Identity(), 1);
  double nees = 0;
  int accepted = 0, tried = 0;
  for (int start = 0; start < 48; start += 3, ++tried) {
    // 12 key frames on a way of their own near the lap's
    std::vector<Pose> way;
    for (int i = 0; i < 12; ++i) {
      Pose T = lap[(start + i) % 48];
      T.translation() += 0.25 * Eigen::Vector3d(uniform(start, i), uniform(start + 100, i), 0);
      T.linear() = so3_exp({0, 0, 0.1 * uniform(start + 200, i)}) * T.linear();
      way.push_back(T);
    }
    const Eigen::Isometry2d truth = frame_of(way);
    const OccupancyMap local = measured_map(way, lifted(truth.inverse()), 50 + start);
    const Eigen::Isometry2d off =
        planar(0.2 * uniform(7, start), 0.2 * uniform(8, start), 0.05 * uniform(9, start));
    const MapMatch match = match_maps(global, local, prior_at(truth * off, 0.15, 2), MapMatchOptions{});
    if (!match.accepted) continue;
    const Eigen::Vector3d e = error(match, truth);
    EXPECT_LT(e.head<2>().norm(), 0.05);
    nees += e.dot(match.pose.covariance.ldlt().solve(e));
    ++accepted;
  }
  EXPECT_GE(accepted, tried * 3 / 4);
  // 3 is exact; the deviations are at most twice too large, and hardly too small
  EXPECT_GT(nees / accepted, 3.0 / 4);
  EXPECT_LT(nees / accepted, 4.5);
}

}  // namespace
}  // namespace groundloop::slam
