#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <algorithm>
#include <array>

#include "sim/truth/bullet.h"
#include "sim/truth/solid.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

/// Keeps the nearest triangle along a ray. Bullet's own ray test lets triangles reach beyond their edges by
/// 1e-4 of their size; this one is exact, and neighbours leave no gap: the products of a common edge differ
/// only in sign.
struct NearestTriangle : btTriangleCallback {
  NearestTriangle(const Vector3d& ray_origin, const Vector3d& ray_direction, double t_max)
      : origin(ray_origin), direction(ray_direction), t_nearest(t_max) {}

  void processTriangle(btVector3* p, int, int) override {
    const Vector3d a = from_bullet(p[0]) - origin, b = from_bullet(p[1]) - origin,
                   c = from_bullet(p[2]) - origin;
    const double u = direction.dot(b.cross(c)), v = direction.dot(c.cross(a)), w = direction.dot(a.cross(b));
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const Vector3d normal = (b - a).cross(c - a);
    const double approach = direction.dot(normal);
    if (!inside || approach == 0) return;
    const double t = a.dot(normal) / approach;
    if (!(t > 0 && t <= t_nearest)) return;
    t_nearest = t;
    nearest = SurfaceHit{t, (approach < 0 ? normal : Vector3d(-normal)).normalized()};
  }

  Vector3d origin;
  Vector3d direction;
  double t_nearest;
  std::optional<SurfaceHit> nearest;
};

/// Calls a test for each triangle whose bounding box meets a box, until one is true.
struct UntilTrue : btTriangleCallback {
  explicit UntilTrue(std::function<bool(const Corners&)> triangle_test) : test(std::move(triangle_test)) {}
  void processTriangle(btVector3* p, int, int) override {
    found = found || test({from_bullet(p[0]), from_bullet(p[1]), from_bullet(p[2])});
  }
  std::function<bool(const Corners&)> test;
  bool found = false;
};

/// Separating axes of a triangle and a box: the box's faces, the triangle's plane, nine products of edges.
bool triangle_reaches_into(const Corners& corners, const OrientedBox& box) {
  Corners p;  // in the box's frame
  for (int i = 0; i < 3; ++i) p[i] = box.axes.transpose() * (corners[i] - box.centre);
  const auto separates = [&](const Vector3d& axis) {
    const double a = p[0].dot(axis), b = p[1].dot(axis), c = p[2].dot(axis);
    const double reach = box.half.dot(axis.cwiseAbs());
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (separates(Vector3d::Unit(i))) return false;
    for (int j = 0; j < 3; ++j) {
      if (separates(Vector3d::Unit(i).cross(p[(j + 1) % 3] - p[j]))) return false;
    }
  }
  return !separates((p[1] - p[0]).cross(p[2] - p[0]));
}

class TriangleSolid : public Solid {
 public:
  explicit TriangleSolid(Triangles triangles)
      : triangles_(std::move(triangles)),
        view_(static_cast<int>(triangles_.corners.cols()), triangles_.corners.data(), 3 * sizeof(int),
              static_cast<int>(triangles_.vertices.cols()), triangles_.vertices.data(), 3 * sizeof(double)),
        shape_(&view_, /*useQuantizedAabbCompression=*/false) {}

  std::optional<SurfaceHit> first_hit(const Vector3d& origin, const Vector3d& direction,
                                      double t_max) const override {
    NearestTriangle callback(origin, direction, t_max);
    shape().performRaycast(&callback, to_bullet(origin), to_bullet(origin + t_max * direction));
    return callback.nearest;
  }

  bool reaches_into(const OrientedBox& box) const override {
    return any_triangle(box, [&](const Corners& corners) { return triangle_reaches_into(corners, box); });
  }

  Vector3d support(const Vector3d& direction) const override {
    Eigen::Index farthest = 0;
    (direction.transpose() * triangles_.vertices).maxCoeff(&farthest);
    return triangles_.vertices.col(farthest);
  }

  bool any_convex_piece(const OrientedBox& box,
                        const std::function<bool(const Support&)>& visit) const override {
    return any_triangle(box, [&](const Corners& corners) {
      return visit([&](const Vector3d& direction) {
        return *std::max_element(corners.begin(), corners.end(), [&](const Vector3d& a, const Vector3d& b) {
          return a.dot(direction) < b.dot(direction);
        });
      });
    });
  }

 private:
  bool any_triangle(const OrientedBox& box, std::function<bool(const Corners&)> test) const {
    const Vector3d reach = box.axes.cwiseAbs() * box.half;
    UntilTrue callback(std::move(test));
    shape_.processAllTriangles(&callback, to_bullet(box.centre - reach), to_bullet(box.centre + reach));
    return callback.found;
  }
  // Bullet's ray cast reads only, but is not declared const.
  btBvhTriangleMeshShape& shape() const { return const_cast<btBvhTriangleMeshShape&>(shape_); }

  Triangles triangles_;
  btTriangleIndexVertexArray view_;
  btBvhTriangleMeshShape shape_;
};

}  // namespace

std::unique_ptr<Solid> make_triangles(Triangles triangles) {
  return std::make_unique<TriangleSolid>(std::move(triangles));
}

}  // namespace groundloop::sim
