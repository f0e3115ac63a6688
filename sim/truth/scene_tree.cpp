#include "sim/truth/scene_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/truth/bullet.h"

namespace groundloop::sim {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Keeps rounding from hiding a surface that lies in the face of its own bounding box.
constexpr double kVolumeMargin_m = 1e-9;

btDbvtVolume volume_of(const SceneGeom& geom) {
  const Vector3d margin = Vector3d::Constant(kVolumeMargin_m);
  return btDbvtVolume::FromMM(to_bullet(geom.extent.min() - margin), to_bullet(geom.extent.max() + margin));
}

/// Where the ray enters the node's volume; infinity when it does not before t_max.
double entry(const btDbvtNode& node, const Vector3d& origin, const Vector3d& inverse_direction,
             double t_max) {
  const btVector3 &low = node.volume.Mins(), &high = node.volume.Maxs();
  double enter = 0, leave = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - origin[axis]) * inverse_direction[axis];
    const double b = (high[axis] - origin[axis]) * inverse_direction[axis];
    // a NaN (origin in the face plane of a parallel slab) leaves the interval as it is
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kInfinity;
}

}  // namespace

std::optional<SurfaceHit> SceneGeom::first_hit(const Vector3d& origin, const Vector3d& direction,
                                               double t_max) const {
  const Eigen::Matrix3d R_geom_world = T_world_geom.linear().transpose();
  auto hit =
      solid->first_hit(R_geom_world * (origin - T_world_geom.translation()), R_geom_world * direction, t_max);
  if (hit) hit->normal = T_world_geom.linear() * hit->normal;
  return hit;
}

OrientedBox SceneGeom::local(const AlignedBox3d& box_world) const {
  const Eigen::Matrix3d R_geom_world = T_world_geom.linear().transpose();
  return {R_geom_world * (box_world.center() - T_world_geom.translation()), R_geom_world,
          box_world.sizes() / 2};
}

Vector3d SceneGeom::support(const Vector3d& direction) const {
  return T_world_geom * solid->support(T_world_geom.linear().transpose() * direction);
}

void SceneGeom::measure() {
  extent.setEmpty();
  for (int axis = 0; axis < 3; ++axis) {
    extent.extend(support(Vector3d::Unit(axis)));
    extent.extend(support(-Vector3d::Unit(axis)));
  }
}

SceneTree::SceneTree(std::vector<SceneGeom> geoms) : geoms_(std::move(geoms)) {
  for (SceneGeom& geom : geoms_) leaves_.push_back(tree_.insert(volume_of(geom), &geom));
  tree_.optimizeTopDown();
}

void SceneTree::move(size_t place, const slam::Pose& T_world_geom) {
  geoms_[place].T_world_geom = T_world_geom;
  geoms_[place].measure();
  btDbvtVolume volume = volume_of(geoms_[place]);
  tree_.update(leaves_[place], volume);
}

std::optional<SceneTree::Hit> SceneTree::cast(const Vector3d& origin, const Vector3d& direction,
                                              double t_max) const {
  const Vector3d inverse_direction = direction.cwiseInverse();
  struct Visit {
    const btDbvtNode* node;
    double enter;
  };
  const auto visit_of = [&](const btDbvtNode* node) {
    return Visit{node, entry(*node, origin, inverse_direction, t_max)};
  };

  std::optional<Hit> nearest;
  std::vector<Visit> waiting;
  waiting.reserve(64);
  if (tree_.m_root != nullptr) waiting.push_back(visit_of(tree_.m_root));
  while (!waiting.empty()) {
    const Visit visit = waiting.back();
    waiting.pop_back();
    if (visit.enter > t_max) continue;
    if (visit.node->isleaf()) {
      const auto* geom = static_cast<const SceneGeom*>(visit.node->data);
      const auto hit = geom->first_hit(origin, direction, t_max);
      // of two geoms with a common surface the lower id is named, whatever the tree looks like
      if (hit && (!nearest || hit->t < nearest->surface.t || geom->id < nearest->geom->id)) {
        nearest = Hit{geom, *hit};
        t_max = hit->t;
      }
    } else {
      Visit nearer = visit_of(visit.node->childs[0]), farther = visit_of(visit.node->childs[1]);
      if (farther.enter < nearer.enter) std::swap(nearer, farther);
      waiting.push_back(farther);
      waiting.push_back(nearer);
    }
  }
  return nearest;
}

const SceneGeom* SceneTree::find(const AlignedBox3d& box_world,
                                 const std::function<bool(const SceneGeom&)>& test) const {
  struct Collect : btDbvt::ICollide {
    void Process(const btDbvtNode* leaf) override {
      found.push_back(static_cast<const SceneGeom*>(leaf->data));
    }
    std::vector<const SceneGeom*> found;
  } collect;
  const auto volume = btDbvtVolume::FromMM(to_bullet(box_world.min()), to_bullet(box_world.max()));
  tree_.collideTV(tree_.m_root, volume, collect);
  std::sort(collect.found.begin(), collect.found.end(),
            [](const SceneGeom* a, const SceneGeom* b) { return a->id < b->id; });
  for (const SceneGeom* geom : collect.found) {
    if (test(*geom)) return geom;
  }
  return nullptr;
}

}  // namespace groundloop::sim
