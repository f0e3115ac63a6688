#include "sim/truth/convex_overlap.h"

#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "sim/truth/bullet.h"

namespace groundloop::sim {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// A Bullet shape that knows nothing but its support function, in the world frame.
class SupportShape : public btConvexInternalShape {
 public:
  explicit SupportShape(Support support) : support_(std::move(support)) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(0);
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& direction) const override {
    return to_bullet(support_(from_bullet(direction)));
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions, btVector3* points,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) points[i] = localGetSupportingVertexWithoutMargin(directions[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "support"; }

 private:
  Support support_;
};

}  // namespace

Support moved(Support local, const slam::Pose& T_world_local) {
  return [local = std::move(local), T_world_local](const Vector3d& direction) -> Vector3d {
    return T_world_local * local(T_world_local.linear().transpose() * direction);
  };
}

Support enlarged(Support body, double margin_m) {
  return [body = std::move(body), margin_m](const Vector3d& direction) -> Vector3d {
    const double length = direction.norm();
    const Vector3d p = body(direction);
    return length > 0 ? Vector3d(p + margin_m / length * direction) : p;
  };
}

AlignedBox3d extent_of(const Support& body) {
  AlignedBox3d extent;
  for (int axis = 0; axis < 3; ++axis) {
    extent.extend(body(Vector3d::Unit(axis)));
    extent.extend(body(-Vector3d::Unit(axis)));
  }
  return extent;
}

bool overlap(const Support& a, const Support& b, const Vector3d& guess) {
  const SupportShape shape_a(a), shape_b(b);
  btGjkEpaSolver2::sResults result;
  const btTransform here = btTransform::getIdentity();
  return !btGjkEpaSolver2::Distance(&shape_a, here, &shape_b, here, to_bullet(guess), result);
}

}  // namespace groundloop::sim
