#include "sim/arm/arm_clearance.h"

#include <algorithm>

#include "sim/truth/convex_overlap.h"

namespace groundloop::sim {
namespace {

using Eigen::AlignedBox3d;

slam::Pose pose_of_geom(const mjData& data, int geom) {
  slam::Pose T_world_geom = slam::Pose::Identity();
  T_world_geom.translation() = Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom);
  T_world_geom.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom);
  return T_world_geom;
}

std::string geom_name(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  if (name != nullptr) return name;
  const char* body = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[geom]);
  return "geom " + std::to_string(geom) + " (body " + (body != nullptr ? body : "without name") + ")";
}

/// Everything of the world but the robot.
std::vector<SceneGeom> obstacles(const World& world, const mjData& data) {
  std::vector<SceneGeom> geoms;
  for (int id = 0; id < world.model().ngeom; ++id) {
    if (world.is_robot_geom(id)) continue;
    SceneGeom geom;
    geom.id = id;
    geom.name = geom_name(world.model(), id);
    geom.solid = make_solid(world.model(), id);
    geom.T_world_geom = pose_of_geom(data, id);
    geom.measure();
    geoms.push_back(std::move(geom));
  }
  return geoms;
}

}  // namespace

ArmClearance::ArmClearance(const World& world, const ArmModel& arm)
    : world_(world), arm_(arm), scene_(obstacles(world, *world.make_data())), scratch_(world.make_data()) {
  for (int geom = 0; geom < world.model().ngeom; ++geom) {
    const auto link = std::find(arm.bodies.begin(), arm.bodies.end(), world.model().geom_bodyid[geom]);
    if (link == arm.bodies.end()) continue;
    parts_.push_back({make_solid(world.model(), geom), geom, static_cast<int>(link - arm.bodies.begin())});
  }
}

std::string ArmClearance::name_of(int geom) const { return geom_name(world_.model(), geom); }

std::optional<std::string> ArmClearance::touch_scene(const Part& part, const Support& body) const {
  const AlignedBox3d extent = extent_of(body);
  const SceneGeom* hit = scene_.find(extent, [&](const SceneGeom& geom) {
    return geom.solid->any_convex_piece(geom.local(extent), [&](const Support& piece) {
      return overlap(body, moved(piece, geom.T_world_geom), extent.center() - geom.extent.center());
    });
  });
  if (hit == nullptr) return std::nullopt;
  return name_of(part.geom) + " touches " + hit->name;
}

std::optional<std::string> ArmClearance::touch(const JointAngles& q, double margin_m) const {
  arm_.set_angles(q, *scratch_);
  mj_kinematics(&world_.model(), scratch_.get());
  std::vector<Support> bodies, with_margin;
  std::vector<AlignedBox3d> extents;  // with margin
  for (const Part& part : parts_) {
    bodies.push_back(
        moved([&part](const Eigen::Vector3d& direction) { return part.solid->support(direction); },
              pose_of_geom(*scratch_, part.geom)));
    with_margin.push_back(enlarged(bodies.back(), margin_m));
    extents.push_back(extent_of(with_margin.back()));
  }
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].link == 0) continue;
    if (auto touched = touch_scene(parts_[i], with_margin[i])) return touched;
    for (size_t j = 0; j < i; ++j) {
      if (parts_[i].link - parts_[j].link < 2 || !extents[i].intersects(extents[j])) continue;
      if (overlap(with_margin[i], bodies[j], extents[i].center() - extents[j].center())) {
        return name_of(parts_[i].geom) + " touches " + name_of(parts_[j].geom);
      }
    }
  }
  return std::nullopt;
}

}  // namespace groundloop::sim
