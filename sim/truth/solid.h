#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>

namespace groundloop::sim {

/// Where a ray meets a surface: distance along the ray in units of its direction, and the normal against the
/// ray.
struct SurfaceHit {
  double t = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// A box with axes of its own, as seen from some frame: {centre + axes u : |u_i| <= half_i}.
struct OrientedBox {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;  ///< orthonormal columns
  Eigen::Vector3d half;
};

/// Gives the farthest point of a convex body in a direction (any length), both in the same frame.
using Support = std::function<Eigen::Vector3d(const Eigen::Vector3d& direction)>;

/// Exact geometry of one geom in the geom's own frame: no collision margins, no facets in place of curves.
class Solid {
 public:
  virtual ~Solid() = default;

  /// First surface at 0 < t <= t_max along origin + t direction; from inside, the surface where the ray
  /// leaves.
  virtual std::optional<SurfaceHit> first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                              double t_max) const = 0;

  /// True when the geometry reaches into the box; touching its faces from outside does not count. Convex
  /// solids are full inside, triangles are surfaces only.
  virtual bool reaches_into(const OrientedBox& box) const = 0;

  /// Support of the convex hull.
  virtual Eigen::Vector3d support(const Eigen::Vector3d& direction) const = 0;

  /// Calls `visit` with the support of every convex piece that may meet the box; true as soon as one call is
  /// true.
  virtual bool any_convex_piece(const OrientedBox& box,
                                const std::function<bool(const Support& piece)>& visit) const;
};

/// |x_i| <= half_i. A half extent of 0 makes a rectangle.
std::unique_ptr<Solid> make_box(const Eigen::Vector3d& half_m);
/// sum (x_i / radius_i)^2 <= 1; a sphere has three equal radii.
std::unique_ptr<Solid> make_ellipsoid(const Eigen::Vector3d& radii_m);
/// All points within the radius of the segment from (0, 0, -half_length) to (0, 0, half_length).
std::unique_ptr<Solid> make_capsule(double radius_m, double half_length_m);
/// x^2 + y^2 <= radius^2, |z| <= half_length.
std::unique_ptr<Solid> make_cylinder(double radius_m, double half_length_m);

/// Vertices [m] as columns and corner numbers of the triangles as columns, counter-clockwise from outside.
struct Triangles {
  Eigen::Matrix3Xd vertices;
  Eigen::Matrix3Xi corners;
};
/// Exactly these triangles, in a Bullet bounding-volume tree.
std::unique_ptr<Solid> make_triangles(Triangles triangles);

/// Triangles of a MuJoCo mesh asset, in the frame of the geoms that use it.
Triangles mesh_triangles(const mjModel& model, int mesh);
/// Surface, skirt and base of a MuJoCo height field; every square is split along the diagonal MuJoCo draws.
Triangles height_field_triangles(const mjModel& model, int height_field);

/// Half extent [m] given to a plane that MuJoCo calls infinite.
inline constexpr double kUnboundedHalf_m = 1e4;

/// The solid of a MuJoCo geom. A plane is the rectangle that is drawn (its collision half-space is not seen).
/// @throws std::invalid_argument for geom types that have no surface
std::unique_ptr<Solid> make_solid(const mjModel& model, int geom);

}  // namespace groundloop::sim
