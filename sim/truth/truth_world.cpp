#include "sim/truth/truth_world.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim/truth/clearance.h"
#include "sim/truth/grid_walk.h"
#include "sim/truth/hull.h"
#include "sim/truth/scene_tree.h"

namespace groundloop::sim {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Geometry that reaches into a cell by less than this only touches it.
constexpr double kTouch_m = 1e-6;
/// Rays of one image in visible_cells().
constexpr int kVisibilityColumns = 128;
constexpr int kVisibilityRows = 40;
constexpr int kOutlineDirections = 64;

std::string body_name(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[geom]);
  return name != nullptr ? name : "body " + std::to_string(model.geom_bodyid[geom]);
}

std::string name_of_geom(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  if (name != nullptr) return name;
  return "geom " + std::to_string(geom) + " (body " + body_name(model, geom) + ")";
}

/// What mjv_updateScene draws with its default options: groups 0 to 2, unless the colour is fully
/// transparent. The geom's own colour counts when it differs from MuJoCo's default or when there is no
/// material.
bool is_visible(const mjModel& model, int geom) {
  constexpr int kHiddenGroups = 3;
  if (model.geom_group[geom] >= kHiddenGroups) return false;
  const float* rgba = model.geom_rgba + 4 * geom;
  const bool own_colour = rgba[0] != 0.5F || rgba[1] != 0.5F || rgba[2] != 0.5F || rgba[3] != 1.0F;
  const int material = model.geom_matid[geom];
  if (material >= 0 && !own_colour) rgba = model.mat_rgba + 4 * material;
  return rgba[3] > 0;
}

slam::Pose pose_of_geom(const mjData& data, int geom) {
  slam::Pose T_world_geom = slam::Pose::Identity();
  T_world_geom.translation() = Eigen::Map<const Vector3d>(data.geom_xpos + 3 * geom);
  T_world_geom.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom);
  if (std::abs(T_world_geom.linear().determinant() - 1) > 1e-6) {
    throw std::invalid_argument("TruthWorld: positions of the state are not computed (call mj_forward)");
  }
  return T_world_geom;
}

std::vector<SceneGeom> scene_geoms(const mjModel& model, const mjData& data,
                                   const std::function<bool(int geom)>& left_out) {
  std::vector<SceneGeom> geoms;
  for (int id = 0; id < model.ngeom; ++id) {
    if (left_out(id) || !is_visible(model, id)) continue;
    SceneGeom geom;
    geom.id = id;
    geom.name = name_of_geom(model, id);
    geom.solid = make_solid(model, id);
    geom.T_world_geom = pose_of_geom(data, id);
    const mjtNum* size = model.geom_size + 3 * id;
    geom.unbounded = model.geom_type[id] == mjGEOM_PLANE && (size[0] <= 0 || size[1] <= 0);
    geom.measure();
    geoms.push_back(std::move(geom));
  }
  return geoms;
}

/// Part of a ray between two heights, as an interval of its parameter within [0, t_max].
std::optional<std::pair<double, double>> in_band(double z, double dz, double z_min, double z_max,
                                                 double t_max) {
  double from = 0, to = t_max;
  if (dz != 0) {
    from = std::max(from, std::min((z_min - z) / dz, (z_max - z) / dz));
    to = std::min(to, std::max((z_min - z) / dz, (z_max - z) / dz));
  } else if (z < z_min || z > z_max) {
    return std::nullopt;
  }
  if (from > to) return std::nullopt;
  return std::pair(from, to);
}

/// What rays see of the cells of a grid.
struct SightMap {
  const slam::GridGeometry& grid;
  std::vector<uint8_t> cells;  ///< CellSight
  double z_min_m, z_max_m;

  void mark(int col, int row, CellSight sight) {
    uint8_t& cell = cells[grid.index(col, row)];
    cell = std::max<uint8_t>(cell, sight);
  }

  /// A ray of unit direction that ends after length_m, on a surface when there is a normal.
  void add(const Vector3d& origin, const Vector3d& ray, double length_m, const Vector3d* normal) {
    const auto band = in_band(origin.z(), ray.z(), z_min_m, z_max_m, length_m);
    if (!band) return;
    walk_cells(grid, (origin + band->first * ray).head<2>(), (origin + band->second * ray).head<2>(),
               [this](int col, int row) { mark(col, row, kCrossed); });
    if (normal == nullptr || band->second < length_m) return;
    const Vector3d behind = origin + length_m * ray - 2 * kTouch_m * *normal;
    const int col = grid.col_of(behind.x()), row = grid.row_of(behind.y());
    const bool upright = std::abs(normal->z()) < std::numbers::sqrt2 / 2;
    if (grid.contains(col, row)) mark(col, row, upright ? kFaceSeen : kCrossed);
  }
};

}  // namespace

struct TruthWorld::Impl {
  Impl(const mjModel& mj_model, const mjData& data, int robot_body, const std::function<bool(int)>& left_out)
      : model(mj_model), scene(scene_geoms(mj_model, data, left_out)), robot(mj_model, robot_body) {}

  const mjModel& model;
  std::function<bool(int geom)> is_person = [](int) { return false; };
  SceneTree scene;
  RobotFootprint robot;
};

TruthWorld::TruthWorld(const mjModel& model, const mjData& data, int robot_body)
    : impl_(std::make_unique<Impl>(model, data, robot_body, [&](int geom) {
        return robot_body >= 0 && model.body_rootid[model.geom_bodyid[geom]] == robot_body;
      })) {}
TruthWorld::TruthWorld(const World& world, const mjData& data, People people)
    : impl_(std::make_unique<Impl>(world.model(), data, world.robot_body(), [&](int geom) {
        return world.is_robot_geom(geom) || (people == People::kLeftOut && world.is_person_geom(geom));
      })) {
  impl_->is_person = [&world](int geom) { return world.is_person_geom(geom); };
}
TruthWorld::~TruthWorld() = default;

void TruthWorld::move_to(const mjData& data) {
  const std::vector<SceneGeom>& geoms = impl_->scene.geoms();
  for (size_t i = 0; i < geoms.size(); ++i) {
    const slam::Pose T_world_geom = pose_of_geom(data, geoms[i].id);
    if (T_world_geom.matrix() != geoms[i].T_world_geom.matrix()) impl_->scene.move(i, T_world_geom);
  }
}

std::optional<slam::Pose> TruthWorld::T_world_geom(int geom) const {
  const std::vector<SceneGeom>& geoms = impl_->scene.geoms();
  const auto found = std::lower_bound(geoms.begin(), geoms.end(), geom,
                                      [](const SceneGeom& g, int id) { return g.id < id; });
  if (found == geoms.end() || found->id != geom) return std::nullopt;
  return found->T_world_geom;
}

std::optional<RayHit> TruthWorld::cast(const Vector3d& origin_world, const Vector3d& direction_world,
                                       double max_distance_m) const {
  const Vector3d direction = direction_world.normalized();
  const auto hit = impl_->scene.cast(origin_world, direction, max_distance_m);
  if (!hit) return std::nullopt;
  return RayHit{hit->surface.t, origin_world + hit->surface.t * direction, hit->surface.normal,
                hit->geom->id};
}

std::optional<double> TruthWorld::depth_m(const slam::StereoRig& rig, const slam::Pose& T_world_left,
                                          double u_px, double v_px, double max_depth_m) const {
  // with z = 1 in the camera the ray's parameter is the depth
  const Vector3d ray_left((u_px - rig.cx_px) / rig.fx_px, (v_px - rig.cy_px) / rig.fy_px, 1);
  const auto hit =
      impl_->scene.cast(T_world_left.translation(), T_world_left.linear() * ray_left, max_depth_m);
  if (!hit) return std::nullopt;
  return hit->surface.t;
}

slam::OccupancyMap TruthWorld::occupancy(const slam::GridGeometry& grid, double z_min_m,
                                         double z_max_m) const {
  slam::OccupancyMap map{grid, std::vector<float>(grid.cells(), 0.0F)};
  const Vector3d touch = Vector3d::Constant(kTouch_m);
  for (const SceneGeom& geom : impl_->scene.geoms()) {
    if (geom.extent.max().z() <= z_min_m + kTouch_m || geom.extent.min().z() >= z_max_m - kTouch_m) continue;
    // clamped before rounding: an unbounded plane is wider than an int counts cells
    const auto first = [](double cells) { return static_cast<int>(std::floor(std::max(cells, 0.0))); };
    const auto last = [](double cells, int n) {
      return static_cast<int>(std::floor(std::min(cells, n - 1.0)));
    };
    const Vector2d origin(grid.x_min_m, grid.y_min_m);
    const Vector2d low = (geom.extent.min().head<2>() - origin) / grid.cell_m;
    const Vector2d high = (geom.extent.max().head<2>() - origin) / grid.cell_m;
    for (int row = first(low.y() - 1); row <= last(high.y(), grid.rows); ++row) {
      for (int col = first(low.x() - 1); col <= last(high.x(), grid.cols); ++col) {
        float& value = map.value[grid.index(col, row)];
        if (value > 0) continue;
        const Vector3d corner(grid.x_min_m + col * grid.cell_m, grid.y_min_m + row * grid.cell_m, z_min_m);
        const Vector3d opposite(corner.x() + grid.cell_m, corner.y() + grid.cell_m, z_max_m);
        if (geom.solid->reaches_into(geom.local(AlignedBox3d(corner + touch, opposite - touch)))) value = 1;
      }
    }
  }
  return map;
}

slam::GridGeometry TruthWorld::bounds(double cell_m) const {
  AlignedBox3d extent;
  for (const SceneGeom& geom : impl_->scene.geoms()) {
    if (!geom.unbounded) extent.extend(geom.extent);
  }
  slam::GridGeometry grid;
  grid.cell_m = cell_m;
  if (extent.isEmpty()) return grid;
  // geometry that ends on a border of cells does not need the next cell, whatever the rounding
  const auto low = [&](int axis) { return std::floor(extent.min()[axis] / cell_m + kTouch_m) - 1; };
  const auto high = [&](int axis) { return std::ceil(extent.max()[axis] / cell_m - kTouch_m) + 1; };
  grid.x_min_m = low(0) * cell_m;
  grid.y_min_m = low(1) * cell_m;
  grid.cols = static_cast<int>(high(0) - low(0));
  grid.rows = static_cast<int>(high(1) - low(1));
  return grid;
}

std::vector<uint8_t> TruthWorld::visible_cells(const slam::GridGeometry& grid, const slam::StereoRig& rig,
                                               const std::vector<slam::Pose>& T_world_left, double z_min_m,
                                               double z_max_m, double max_range_m) const {
  SightMap sight{grid, std::vector<uint8_t>(grid.cells(), kUnseen), z_min_m, z_max_m};
  for (const slam::Pose& T : T_world_left) {
    for (int j = 0; j < kVisibilityRows; ++j) {
      for (int i = 0; i < kVisibilityColumns; ++i) {
        // centres of equal tiles; the image reaches half a pixel beyond its first and last pixel centres
        const double u_px = (i + 0.5) * rig.width_px / kVisibilityColumns - 0.5;
        const double v_px = (j + 0.5) * rig.height_px / kVisibilityRows - 0.5;
        const Vector3d ray_left((u_px - rig.cx_px) / rig.fx_px, (v_px - rig.cy_px) / rig.fy_px, 1);
        const Vector3d ray = T.linear() * ray_left.normalized();
        const auto hit = impl_->scene.cast(T.translation(), ray, max_range_m);
        const bool face = hit && !impl_->is_person(hit->geom->id);
        sight.add(T.translation(), ray, hit ? hit->surface.t : max_range_m,
                  face ? &hit->surface.normal : nullptr);
      }
    }
  }
  return sight.cells;
}

std::optional<std::string> TruthWorld::collision(double x_m, double y_m, double yaw_rad,
                                                 double margin_m) const {
  const SceneGeom* geom = impl_->robot.collision(impl_->scene, x_m, y_m, yaw_rad, margin_m);
  if (geom == nullptr) return std::nullopt;
  return geom->name;
}

double TruthWorld::robot_radius_m() const { return impl_->robot.radius_m(); }

std::vector<Outline> TruthWorld::footprints(double z_min_m, double z_max_m) const {
  std::vector<Outline> outlines;
  for (const SceneGeom& geom : impl_->scene.geoms()) {
    const double low = geom.extent.min().z(), high = geom.extent.max().z();
    if (geom.unbounded || high <= z_min_m || low >= z_max_m) continue;
    std::vector<Vector2d> points;
    for (int i = 0; i < kOutlineDirections; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kOutlineDirections;
      points.push_back(geom.support({std::cos(angle), std::sin(angle), 0}).head<2>());
    }
    outlines.push_back(
        {geom.id, geom.name, body_name(impl_->model, geom.id), convex_hull(points), low, high});
  }
  return outlines;
}

std::string TruthWorld::geom_name(int geom) const { return name_of_geom(impl_->model, geom); }

}  // namespace groundloop::sim
