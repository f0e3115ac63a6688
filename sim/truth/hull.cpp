#include "sim/truth/hull.h"

#include <algorithm>
#include <limits>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to_segment(const Vector2d& point, const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  const double squared = along.squaredNorm();
  const double s = squared > 0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (point - from - s * along).norm();
}

}  // namespace

// Monotone chain: the lower and the upper boundary from left to right.
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vector2d> hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const size_t start = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();  // the end of one chain starts the other
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

double distance_to_hull(const Vector2d& point, const std::vector<Vector2d>& hull) {
  bool inside = hull.size() >= 3;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vector2d &from = hull[i], &to = hull[(i + 1) % hull.size()];
    if (cross(to - from, point - from) < 0) inside = false;
    least = std::min(least, distance_to_segment(point, from, to));
  }
  return inside ? 0 : least;
}

// Corner i lies on the positive side of axis k when bit k of i is set.
std::array<Vector3d, 8> box_corners(const OrientedBox& box) {
  std::array<Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3d side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    corners[i] = box.centre + box.axes * box.half.cwiseProduct(side);
  }
  return corners;
}

const Edges& box_edges() {
  static const Edges edges = {{{0, 1},
                               {2, 3},
                               {4, 5},
                               {6, 7},  // along x
                               {0, 2},
                               {1, 3},
                               {4, 6},
                               {5, 7},  // along y
                               {0, 4},
                               {1, 5},
                               {2, 6},
                               {3, 7}}};  // along z
  return edges;
}

std::vector<Vector2d> project_slab(const std::array<Vector3d, 8>& corners, const Edges& edges, double z_min,
                                   double z_max) {
  std::vector<Vector2d> points;
  for (const Vector3d& p : corners) {
    if (p.z() >= z_min && p.z() <= z_max) points.push_back(p.head<2>());
  }
  for (const auto& [i, j] : edges) {
    for (const double z : {z_min, z_max}) {
      const double below = z - corners[i].z(), above = corners[j].z() - z;
      if (below * above > 0) {
        const double s = below / (below + above);
        points.push_back((1 - s) * corners[i].head<2>() + s * corners[j].head<2>());
      }
    }
  }
  return points;
}

}  // namespace groundloop::sim
