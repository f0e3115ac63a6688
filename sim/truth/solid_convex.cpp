#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/truth/hull.h"
#include "sim/truth/solid.h"

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Part of a ray that lies in a convex body.
struct Interval {
  double enter = -kInfinity;
  double leave = kInfinity;
  bool empty() const { return !(enter <= leave); }
};

Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

/// |x| <= half on a line x = origin + t direction.
Interval in_slab(double origin, double direction, double half) {
  if (direction == 0) return std::abs(origin) <= half ? Interval{} : Interval{kInfinity, -kInfinity};
  const double t_a = (-half - origin) / direction, t_b = (half - origin) / direction;
  return {std::min(t_a, t_b), std::max(t_a, t_b)};
}

/// |x| <= radius for x = origin + t direction in two or three dimensions; measured from the point of closest
/// approach, which keeps its digits when the origin is far away.
template <class Vector>
Interval in_ball(const Vector& origin, const Vector& direction, double radius) {
  const double squared_speed = direction.squaredNorm();
  if (squared_speed == 0) {
    return origin.squaredNorm() <= radius * radius ? Interval{} : Interval{kInfinity, -kInfinity};
  }
  const double t_closest = -origin.dot(direction) / squared_speed;
  const double miss_squared = radius * radius - (origin + t_closest * direction).squaredNorm();
  if (miss_squared < 0) return {kInfinity, -kInfinity};
  const double half_chord = std::sqrt(miss_squared / squared_speed);
  return {t_closest - half_chord, t_closest + half_chord};
}

/// The first end of the interval that lies on the ray.
std::optional<double> first_end(const Interval& inside, double t_max) {
  if (inside.empty()) return std::nullopt;
  const double t = inside.enter > 0 ? inside.enter : inside.leave;
  if (!(t > 0 && t <= t_max)) return std::nullopt;
  return t;
}

SurfaceHit against_ray(double t, const Vector3d& outward, const Vector3d& direction) {
  return {t, outward.dot(direction) <= 0 ? outward : Vector3d(-outward)};
}

class BoxSolid : public Solid {
 public:
  explicit BoxSolid(const Vector3d& half) : half_(half) {}

  std::optional<SurfaceHit> first_hit(const Vector3d& origin, const Vector3d& direction,
                                      double t_max) const override {
    Interval inside;
    int enter_axis = 0, leave_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Interval slab = in_slab(origin[axis], direction[axis], half_[axis]);
      if (slab.enter > inside.enter) inside.enter = slab.enter, enter_axis = axis;
      if (slab.leave < inside.leave) inside.leave = slab.leave, leave_axis = axis;
    }
    const auto t = first_end(inside, t_max);
    if (!t) return std::nullopt;
    return against_ray(*t, Vector3d::Unit(*t == inside.enter ? enter_axis : leave_axis), direction);
  }

  // Separating axes of two boxes: three faces of each and the nine products of edges.
  bool reaches_into(const OrientedBox& box) const override {
    for (int i = 0; i < 3; ++i) {
      if (separates(Vector3d::Unit(i), box) || separates(box.axes.col(i), box)) return false;
      for (int j = 0; j < 3; ++j) {
        if (separates(Vector3d::Unit(i).cross(box.axes.col(j)), box)) return false;
      }
    }
    return true;
  }

  Vector3d support(const Vector3d& direction) const override {
    return half_.cwiseProduct(direction.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; }));
  }

 private:
  bool separates(const Vector3d& axis, const OrientedBox& box) const {
    const double reach = half_.dot(axis.cwiseAbs()) + box.half.dot((box.axes.transpose() * axis).cwiseAbs());
    return std::abs(box.centre.dot(axis)) > reach;
  }

  Vector3d half_;
};

class EllipsoidSolid : public Solid {
 public:
  explicit EllipsoidSolid(const Vector3d& radii) : radii_(radii) {}

  std::optional<SurfaceHit> first_hit(const Vector3d& origin, const Vector3d& direction,
                                      double t_max) const override {
    const Vector3d unit_origin = origin.cwiseQuotient(radii_),
                   unit_direction = direction.cwiseQuotient(radii_);
    const auto t = first_end(in_ball(unit_origin, unit_direction, 1), t_max);
    if (!t) return std::nullopt;
    const Vector3d gradient = (unit_origin + *t * unit_direction).cwiseQuotient(radii_);
    return against_ray(*t, gradient.normalized(), direction);
  }

  // In units of the radii the box is a parallelepiped {c + A u : |u_i| <= 1}, to be met by the unit ball. Its
  // point nearest to the centre is inside, or on a face, edge or corner: the least over all 27 choices that
  // set each u_i to -1, to 1 or free is exact, because each choice with all |u_i| <= 1 is a point of the box.
  bool reaches_into(const OrientedBox& box) const override {
    const Vector3d inverse = radii_.cwiseInverse();
    const Vector3d c = inverse.cwiseProduct(box.centre);
    const Eigen::Matrix3d a = inverse.asDiagonal() * box.axes * box.half.asDiagonal();
    for (int choice = 0; choice < 27; ++choice) {
      const std::array<int, 3> side = {choice % 3 - 1, choice / 3 % 3 - 1, choice / 9 - 1};
      Vector3d fixed_part = c;
      std::array<int, 3> free{};
      int n = 0;
      for (int i = 0; i < 3; ++i) {
        if (side[i] == 0) free[n++] = i;
        fixed_part += side[i] * a.col(i);
      }
      Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3> columns(3, n);
      for (int i = 0; i < n; ++i) columns.col(i) = a.col(free[i]);
      if (n > 0) {
        const Eigen::VectorXd u =
            -(columns.transpose() * columns).ldlt().solve(columns.transpose() * fixed_part);
        if (u.cwiseAbs().maxCoeff() > 1) continue;
        fixed_part += columns * u;
      }
      if (fixed_part.squaredNorm() <= 1) return true;
    }
    return false;
  }

  Vector3d support(const Vector3d& direction) const override {
    const Vector3d scaled = radii_.cwiseProduct(direction);
    const double length = scaled.norm();
    return length > 0 ? Vector3d(radii_.cwiseProduct(scaled) / length) : Vector3d(radii_.x(), 0, 0);
  }

 private:
  Vector3d radii_;
};

class CapsuleSolid : public Solid {
 public:
  CapsuleSolid(double radius, double half_length) : radius_(radius), half_length_(half_length) {}

  // Union of a cylinder and two balls; it is convex, so the parts of the ray join to one interval.
  std::optional<SurfaceHit> first_hit(const Vector3d& origin, const Vector3d& direction,
                                      double t_max) const override {
    Interval inside{kInfinity, -kInfinity};
    const auto join = [&inside](const Interval& part) {
      if (!part.empty()) inside = {std::min(inside.enter, part.enter), std::max(inside.leave, part.leave)};
    };
    join(intersection(in_ball<Vector2d>(origin.head<2>(), direction.head<2>(), radius_),
                      in_slab(origin.z(), direction.z(), half_length_)));
    join(in_ball<Vector3d>(origin - end(1), direction, radius_));
    join(in_ball<Vector3d>(origin - end(-1), direction, radius_));
    const auto t = first_end(inside, t_max);
    if (!t) return std::nullopt;
    const Vector3d p = origin + *t * direction;
    const Vector3d on_axis(0, 0, std::clamp(p.z(), -half_length_, half_length_));
    return against_ray(*t, (p - on_axis).normalized(), direction);
  }

  // Distance of the segment to the box, both in the box's frame. Its square is convex and piecewise quadratic
  // along the segment; the pieces end where the segment crosses a face plane of the box.
  bool reaches_into(const OrientedBox& box) const override {
    const Vector3d from = box.axes.transpose() * (end(-1) - box.centre);
    const Vector3d along = box.axes.transpose() * (end(1) - end(-1));
    std::vector<double> knots = {0, 1};
    for (int axis = 0; axis < 3; ++axis) {
      if (along[axis] == 0) continue;
      for (const double side : {-1.0, 1.0}) {
        knots.push_back(std::clamp((side * box.half[axis] - from[axis]) / along[axis], 0.0, 1.0));
      }
    }
    std::sort(knots.begin(), knots.end());
    const auto outside = [&](double s) -> Vector3d {
      const Vector3d p = from + s * along;
      return p - p.cwiseMax(-box.half).cwiseMin(box.half);
    };
    double least_squared = kInfinity;
    for (size_t i = 0; i + 1 < knots.size(); ++i) {
      // outside(s) is linear on the piece
      const Vector3d at_start = outside(knots[i]), change = outside(knots[i + 1]) - at_start;
      const double bend = change.squaredNorm();
      const double s = bend > 0 ? std::clamp(-at_start.dot(change) / bend, 0.0, 1.0) : 0.0;
      least_squared = std::min(least_squared, (at_start + s * change).squaredNorm());
    }
    return least_squared <= radius_ * radius_;
  }

  Vector3d support(const Vector3d& direction) const override {
    const double length = direction.norm();
    const Vector3d ball = length > 0 ? Vector3d(radius_ / length * direction) : Vector3d(radius_, 0, 0);
    return end(direction.z() < 0 ? -1 : 1) + ball;
  }

 private:
  Vector3d end(double side) const { return {0, 0, side * half_length_}; }

  double radius_;
  double half_length_;
};

class CylinderSolid : public Solid {
 public:
  CylinderSolid(double radius, double half_length) : radius_(radius), half_length_(half_length) {}

  std::optional<SurfaceHit> first_hit(const Vector3d& origin, const Vector3d& direction,
                                      double t_max) const override {
    const Interval round = in_ball<Vector2d>(origin.head<2>(), direction.head<2>(), radius_);
    const Interval flat = in_slab(origin.z(), direction.z(), half_length_);
    const Interval inside = intersection(round, flat);
    const auto t = first_end(inside, t_max);
    if (!t) return std::nullopt;
    if (*t == flat.enter || *t == flat.leave) return against_ray(*t, Vector3d::UnitZ(), direction);
    const Vector3d p = origin + *t * direction;
    return against_ray(*t, Vector3d(p.x(), p.y(), 0).normalized(), direction);
  }

  // The part of the box between the two caps is convex; seen along the axis it is a polygon, which must meet
  // the disc.
  bool reaches_into(const OrientedBox& box) const override {
    const std::vector<Vector2d> seen =
        project_slab(box_corners(box), box_edges(), -half_length_, half_length_);
    if (seen.empty()) return false;
    return distance_to_hull(Vector2d::Zero(), convex_hull(seen)) <= radius_;
  }

  Vector3d support(const Vector3d& direction) const override {
    const double across = direction.head<2>().norm();
    Vector3d p(radius_, 0, direction.z() < 0 ? -half_length_ : half_length_);
    if (across > 0) p.head<2>() = radius_ / across * direction.head<2>();
    return p;
  }

 private:
  double radius_;
  double half_length_;
};

}  // namespace

bool Solid::any_convex_piece(const OrientedBox&, const std::function<bool(const Support&)>& visit) const {
  return visit([this](const Vector3d& direction) { return support(direction); });
}

std::unique_ptr<Solid> make_box(const Vector3d& half_m) { return std::make_unique<BoxSolid>(half_m); }

std::unique_ptr<Solid> make_ellipsoid(const Vector3d& radii_m) {
  return std::make_unique<EllipsoidSolid>(radii_m);
}

std::unique_ptr<Solid> make_capsule(double radius_m, double half_length_m) {
  return std::make_unique<CapsuleSolid>(radius_m, half_length_m);
}

std::unique_ptr<Solid> make_cylinder(double radius_m, double half_length_m) {
  return std::make_unique<CylinderSolid>(radius_m, half_length_m);
}

}  // namespace groundloop::sim
