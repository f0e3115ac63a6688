#pragma once

#include <LinearMath/btVector3.h>

#include <Eigen/Core>

static_assert(sizeof(btScalar) == sizeof(double), "the truth needs Bullet's double precision build");

namespace groundloop::sim {

inline btVector3 to_bullet(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
inline Eigen::Vector3d from_bullet(const btVector3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace groundloop::sim
