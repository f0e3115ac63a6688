#include "tests/slam/mapping/room_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

/// Counter-based noise: the same key gives the same number, whatever was drawn before (splitmix64).
double uniform(uint64_t seed, uint64_t stream, uint64_t index) {
  uint64_t x = seed * 0x9E3779B97F4A7C15ULL + stream * 0xD1B54A32D192ED03ULL + index * 0x8CB92BA72F3D8DD7ULL;
  for (const uint64_t factor : {0xBF58476D1CE4E5B9ULL, 0x94D049BB133111EBULL}) x = (x ^ (x >> 30)) * factor;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1.0p-53;
}
double normal(uint64_t seed, uint64_t stream, uint64_t index) {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(seed, stream, index)));
  return radius * std::cos(2 * std::numbers::pi * uniform(seed, stream + 1, index));
}

void add_desk(std::vector<Box>& boxes, double x, double y) {
  boxes.push_back({{x, y, 0.71}, {x + 1.6, y + 0.8, 0.75}});
  for (const double leg_x : {x, x + 1.55}) {
    for (const double leg_y : {y, y + 0.75})
      boxes.push_back({{leg_x, leg_y, 0}, {leg_x + 0.05, leg_y + 0.05, 0.71}});
  }
  boxes.push_back({{x + 0.5, y + 0.35, 0.75}, {x + 0.95, y + 0.5, 1.15}});  // monitor
}

}  // namespace

RoomWorld RoomWorld::laboratory() {
  RoomWorld world;
  world.boxes = {
      {{-7.12, -4.62, 0}, {-7.02, 4.62, 3}},    {{7.02, -4.62, 0}, {7.12, 4.62, 3}},      // walls
      {{-7.12, -4.62, 0}, {7.12, -4.52, 3}},    {{-7.12, 4.52, 0}, {7.12, 4.62, 3}},      //
      {{-7.12, -4.62, -0.1}, {7.12, 4.62, 0}},  {{-7.12, -4.62, 3}, {7.12, 4.62, 3.1}},   // floor, ceiling
      {{-3.13, -4.52, 0}, {-2.22, -4.07, 1.9}}, {{1.03, 4.06, 0}, {2.84, 4.52, 1.9}},     // cupboards
      {{6.57, -1.01, 0}, {7.02, 0.88, 2.2}},    {{-0.38, -0.27, 0}, {0.23, 0.31, 0.62}},  // shelf, crate
      {{-6.61, 3.18, 0}, {-6.19, 3.61, 0.41}},  {{5.12, 3.43, 0}, {5.53, 3.84, 1.22}},    // crates
  };
  add_desk(world.boxes, -1.17, -4.21);
  add_desk(world.boxes, 3.06, -3.92);
  add_desk(world.boxes, -4.58, 3.58);
  add_desk(world.boxes, -0.83, 0.52);
  return world;
}

std::optional<double> RoomWorld::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  double nearest = 1e9;
  for (const Box& box : boxes) {
    double enter = 0, leave = nearest;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - origin[axis]) / direction[axis];
      const double b = (box.high[axis] - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) nearest = enter;
  }
  if (nearest == 1e9) return std::nullopt;
  return nearest;
}

OccupancyMap RoomWorld::occupancy(const GridGeometry& geometry, double z_min_m, double z_max_m) const {
  OccupancyMap map{geometry, std::vector<float>(geometry.cells(), 0)};
  for (const Box& box : boxes) {
    if (box.low.z() >= z_max_m || box.high.z() <= z_min_m) continue;
    for (int row = geometry.row_of(box.low.y()); row <= geometry.row_of(box.high.y()); ++row) {
      for (int col = geometry.col_of(box.low.x()); col <= geometry.col_of(box.high.x()); ++col) {
        if (geometry.contains(col, row)) map.value[geometry.index(col, row)] = 1;
      }
    }
  }
  return map;
}

StereoRig laboratory_rig() { return centred_rig(640, 480, 576.9, 0.088); }

std::vector<Pose> laboratory_lap(int key_frames) {
  std::vector<Pose> poses;
  for (int i = 0; i < key_frames; ++i) {
    const double angle = 2 * std::numbers::pi * i / key_frames;
    const Eigen::Vector2d at(4.4 * std::cos(angle), 2.2 * std::sin(angle));
    const Eigen::Vector2d along(-4.4 * std::sin(angle), 2.2 * std::cos(angle));
    Pose T_map_body = Pose::Identity();
    T_map_body.linear() = so3_exp({0, 0, std::atan2(along.y(), along.x())});
    T_map_body.translation() << at, 0;
    poses.push_back(T_map_body * StereoRig::level_camera({0, 0, 0.35}));
  }
  return poses;
}

std::vector<MapPoint> measure(const RoomWorld& world, const StereoRig& rig, const Pose& T_map_left, int count,
                              double sigma_disparity_px, uint64_t seed) {
  std::vector<MapPoint> points;
  const double sigma_px = sigma_disparity_px / std::sqrt(2.0);
  for (int i = 0; i < count; ++i) {
    const double u = uniform(seed, 0, i) * rig.width_px, v = uniform(seed, 1, i) * rig.height_px;
    const Eigen::Vector3d ray_left((u - rig.cx_px) / rig.fx_px, (v - rig.cy_px) / rig.fy_px, 1);
    const double length = ray_left.norm();
    const auto distance = world.cast(T_map_left.translation(), T_map_left.linear() * ray_left / length);
    if (!distance) continue;
    Eigen::Vector3d uvu = rig.project(ray_left * (*distance / length));
    uvu.x() += sigma_px * normal(seed, 2, i);
    uvu.z() += sigma_px * normal(seed, 4, i);
    if (const auto point = map_point(rig, T_map_left, uvu, sigma_disparity_px, 1)) points.push_back(*point);
  }
  return points;
}

std::vector<uint8_t> visible_cells(const RoomWorld& world, const StereoRig& rig,
                                   const std::vector<Pose>& T_map_left, const GridGeometry& geometry,
                                   double z_min_m, double z_max_m, double max_range_m) {
  std::vector<uint8_t> sight(geometry.cells(), kUnseen);
  const auto see = [&](const Eigen::Vector3d& p, CellSight what) {
    if (p.z() <= z_min_m || p.z() >= z_max_m) return;
    const int col = geometry.col_of(p.x()), row = geometry.row_of(p.y());
    if (!geometry.contains(col, row)) return;
    uint8_t& cell = sight[geometry.index(col, row)];
    cell = std::max<uint8_t>(cell, what);
  };
  for (const Pose& T : T_map_left) {
    for (int v = 0; v < rig.height_px; v += 12) {
      for (int u = 0; u < rig.width_px; u += 6) {
        const Eigen::Vector3d ray_left((u - rig.cx_px) / rig.fx_px, (v - rig.cy_px) / rig.fy_px, 1);
        const Eigen::Vector3d direction = (T.linear() * ray_left).normalized();
        const double hit_m = world.cast(T.translation(), direction).value_or(1e9);
        for (double s = 0; s < std::min(hit_m, max_range_m); s += 0.03)
          see(T.translation() + s * direction, kCrossed);
        if (hit_m < max_range_m) see(T.translation() + (hit_m + 1e-6) * direction, kSurfaceSeen);
      }
    }
  }
  return sight;
}

MapScore score(const OccupancyMap& map, const OccupancyMap& truth, const std::vector<uint8_t>& sight) {
  const GridGeometry& grid = truth.geometry;
  const auto called = [&](int col, int row) {
    const Eigen::Vector2d centre_m = grid.centre_m(col, row);
    return map.at_point(centre_m.x(), centre_m.y());
  };
  const auto called_occupied = [&](int col, int row) {
    return called(col, row) > OccupancyMap::kOccupiedAbove;
  };
  const auto occupied = [&](int col, int row) {
    return grid.contains(col, row) && truth.at(col, row) > 0.5F;
  };
  const auto wall = [&](int col, int row) {
    return occupied(col, row) && sight[grid.index(col, row)] == kSurfaceSeen;
  };
  const auto near = [](int col, int row, const auto& is) {
    for (int i = 0; i < 9; ++i) {
      if (is(col + i % 3 - 1, row + i / 3 - 1)) return true;
    }
    return false;
  };
  double alarms = 0, right = 0, walls = 0, found = 0, free = 0, called_free = 0, false_free = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const bool seen = sight[grid.index(col, row)] != kUnseen;
      const bool says_free = called(col, row) < OccupancyMap::kFreeBelow;
      if (called_occupied(col, row) && (seen || near(col, row, wall)))
        alarms += 1, right += near(col, row, occupied);
      if (wall(col, row)) {
        walls += 1, found += near(col, row, called_occupied);
        false_free += says_free && !near(col, row, called_occupied);
      } else if (seen && !occupied(col, row)) {
        free += 1, called_free += says_free;
      }
    }
  }
  MapScore result;
  result.precision = right / std::max(1.0, alarms), result.recall = found / std::max(1.0, walls);
  result.f1 = 2 * result.precision * result.recall / std::max(1e-9, result.precision + result.recall);
  result.free_recall = called_free / std::max(1.0, free);
  result.false_free_m2 = false_free * grid.cell_m * grid.cell_m;
  return result;
}

}  // namespace groundloop::slam
