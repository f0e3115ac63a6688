#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/truth/solid.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// One geom of the scene at its place in the world.
struct SceneGeom {
  int id = -1;       ///< MuJoCo geom id
  std::string name;  ///< its name, or "geom 17 (body desk)"
  std::unique_ptr<Solid> solid;
  slam::Pose T_world_geom = slam::Pose::Identity();
  Eigen::AlignedBox3d extent;  ///< world frame
  bool unbounded = false;      ///< a plane that MuJoCo calls infinite

  /// First surface along origin + t direction, both in the world; the normal too.
  std::optional<SurfaceHit> first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                      double t_max) const;
  /// Farthest point in a direction; both in the world.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// Sets the extent from solid and place.
  void measure();
  /// The axis-aligned world box as the solid sees it.
  OrientedBox local(const Eigen::AlignedBox3d& box_world) const;
};

/// Geoms in a Bullet dynamic bounding-volume tree.
class SceneTree {
 public:
  explicit SceneTree(std::vector<SceneGeom> geoms);

  const std::vector<SceneGeom>& geoms() const { return geoms_; }
  /// Puts the geom of a place in geoms() elsewhere.
  void move(size_t place, const slam::Pose& T_world_geom);

  struct Hit {
    const SceneGeom* geom;
    SurfaceHit surface;
  };
  /// Nearest surface at 0 < t <= t_max.
  std::optional<Hit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                          double t_max) const;

  /// First geom, in the order of their ids, for which `test` is true among those whose extents meet the box.
  const SceneGeom* find(const Eigen::AlignedBox3d& box_world,
                        const std::function<bool(const SceneGeom&)>& test) const;

 private:
  std::vector<SceneGeom> geoms_;
  std::vector<btDbvtNode*> leaves_;  ///< of each geom
  btDbvt tree_;
};

}  // namespace groundloop::sim
