#include "sim/truth/clearance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/truth/convex_overlap.h"

namespace groundloop::sim {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Wheels stand on the floor; only what rises above this height is an obstacle.
constexpr double kFloorClearance_m = 0.02;

/// The projection of a body to the floor, enlarged by a disc and swept between two heights.
Support swept(Support body, double margin_m, double z_min_m, double z_max_m) {
  return [=, body = std::move(body)](const Vector3d& direction) -> Vector3d {
    const Vector3d across(direction.x(), direction.y(), 0);
    const double length = across.norm();
    Vector3d p = body(across);
    if (length > 0) p += margin_m / length * across;
    p.z() = direction.z() < 0 ? z_min_m : z_max_m;
    return p;
  };
}

/// Farthest horizontal distance of a body from a point; exact to 1 mm in a metre for round bodies.
double radius_about(const Vector3d& centre, const Solid& solid, const slam::Pose& T_world_solid) {
  constexpr int kDirections = 72;
  double radius_m = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kDirections;
    const Vector3d direction(std::cos(angle_rad), std::sin(angle_rad), 0);
    const Vector3d p = T_world_solid * solid.support(T_world_solid.linear().transpose() * direction);
    radius_m = std::max(radius_m, (p - centre).head<2>().norm());
  }
  return radius_m;
}

}  // namespace

RobotFootprint::RobotFootprint(const mjModel& model, int robot_body) {
  if (robot_body < 0) return;
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(&model), mj_deleteData);
  mj_kinematics(&model, data.get());
  const auto pose = [](const mjtNum* position, const mjtNum* rotation) {
    slam::Pose T = slam::Pose::Identity();
    T.translation() = Eigen::Map<const Vector3d>(position);
    T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation);
    return T;
  };
  const slam::Pose T_world_body = pose(data->xpos + 3 * robot_body, data->xmat + 9 * robot_body);
  const double floor_m = T_world_body.translation().z();
  z_min_m_ = floor_m + kFloorClearance_m;
  z_max_m_ = z_min_m_;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.body_rootid[model.geom_bodyid[geom]] != robot_body) continue;
    const slam::Pose T_world_geom = pose(data->geom_xpos + 3 * geom, data->geom_xmat + 9 * geom);
    Part part{make_solid(model, geom), T_world_body.inverse() * T_world_geom};
    const Vector3d top =
        T_world_geom * part.solid->support(T_world_geom.linear().transpose() * Vector3d::UnitZ());
    z_max_m_ = std::max(z_max_m_, top.z());
    radius_m_ = std::max(radius_m_, radius_about(T_world_body.translation(), *part.solid, T_world_geom));
    parts_.push_back(std::move(part));
  }
}

const SceneGeom* RobotFootprint::collision(const SceneTree& scene, double x_m, double y_m, double yaw_rad,
                                           double margin_m) const {
  slam::Pose T_world_body = slam::Pose::Identity();
  T_world_body.translation() << x_m, y_m, z_min_m_ - kFloorClearance_m;
  T_world_body.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  for (const Part& part : parts_) {
    const Support body = moved([&part](const Vector3d& direction) { return part.solid->support(direction); },
                               T_world_body * part.T_body_geom);
    const Support prism = swept(body, margin_m, z_min_m_, z_max_m_);
    const AlignedBox3d extent = extent_of(prism);
    const SceneGeom* hit = scene.find(extent, [&](const SceneGeom& geom) {
      return geom.solid->any_convex_piece(geom.local(extent), [&](const Support& piece) {
        return overlap(prism, moved(piece, geom.T_world_geom), extent.center() - geom.extent.center());
      });
    });
    if (hit != nullptr) return hit;
  }
  return nullptr;
}

}  // namespace groundloop::sim
