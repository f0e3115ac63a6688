#include "sim/generate/roadmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/robot/pose2.h"
#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr double kDensest_m = 0.25, kSparsest_m = 0.5;  ///< between points
constexpr double kWantedPoints = 600;
constexpr double kShortest_m = 0.7, kLongest_m = 3.2;
constexpr size_t kWaysFromPoint = 14;
constexpr double kLargestRadius_m = 3.0, kSharpest_rad = 2.3, kFlattest_rad = 0.03;
constexpr double kTangentShare = 0.48;  ///< of a way that an arc at one of its ends may take
constexpr double kComfort_m = 0.4;      ///< clearance beyond the necessary that is still worth something
constexpr double kTurnCost_m = 0.3, kTurnCost_m_per_rad = 0.3;
enum Stream : uint64_t { kScatter = 11, kJoin = 12 };

double unit(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

bool arc_is_free(const FreeSpace& space, const Pose2& start, double radius_m, double angle_rad) {
  const double length_m = radius_m * std::abs(angle_rad);
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / 0.05)));
  for (int i = 0; i <= steps; ++i) {
    const Pose2 at = driven(start, length_m * i / steps, angle_rad * i / steps);
    if (!space.holds(at.x_m, at.y_m)) return false;
  }
  return true;
}

/// The widest arc that fits, if any.
std::optional<Turn> turn_between(const FreeSpace& space, const Way& a, const Way& b, const Eigen::Vector2d& corner,
                                 double min_radius_m) {
  Turn turn;
  turn.angle_rad = wrapped(b.yaw_rad - a.yaw_rad);
  const double sharpness = std::abs(turn.angle_rad);
  if (sharpness > kSharpest_rad || sharpness < kFlattest_rad) return std::nullopt;
  const double half_tan = std::tan(sharpness / 2);
  const double widest = std::min(kTangentShare * std::min(a.length_m, b.length_m) / half_tan, kLargestRadius_m);
  for (turn.radius_m = widest; turn.radius_m >= min_radius_m; turn.radius_m *= 0.6) {
    turn.tangent_m = turn.radius_m * half_tan;
    const Pose2 start{corner.x() - turn.tangent_m * std::cos(a.yaw_rad),
                      corner.y() - turn.tangent_m * std::sin(a.yaw_rad), a.yaw_rad};
    if (!arc_is_free(space, start, turn.radius_m, turn.angle_rad)) continue;
    turn.cost = kTurnCost_m + kTurnCost_m_per_rad * sharpness;
    return turn;
  }
  return std::nullopt;
}

/// Ways near to things cost up to half as much again.
double cost_of(const FreeSpace& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  double least = kComfort_m;
  for (const double part : {0.25, 0.5, 0.75}) {
    const Eigen::Vector2d p = a + part * (b - a);
    least = std::min(least, space.clearance_m(p.x(), p.y()) - space.need_m());
  }
  return (b - a).norm() * (1.5 - 0.5 * least / kComfort_m);
}

}  // namespace

Roadmap::Roadmap(const FreeSpace& space, const PlanRecipe& recipe, uint64_t seed) {
  scatter_points(space, seed);
  join_points(space, seed);
  find_turns(space, recipe.min_radius_m);
}

/// One point in every square that has room for it.
void Roadmap::scatter_points(const FreeSpace& space, uint64_t seed) {
  const slam::GridGeometry& grid = space.grid();
  const double pitch_m = std::clamp(std::sqrt(space.area_m2() / kWantedPoints), kDensest_m, kSparsest_m);
  const int nx = static_cast<int>(grid.cols * grid.cell_m / pitch_m) + 1;
  const int ny = static_cast<int>(grid.rows * grid.cell_m / pitch_m) + 1;
  for (int i = 0; i < nx * ny; ++i) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      const auto draw = static_cast<uint64_t>(i) * 8 + static_cast<uint64_t>(attempt) * 2;
      const double x = grid.x_min_m + (i % nx + unit(random_bits(seed, kScatter, draw))) * pitch_m;
      const double y = grid.y_min_m + (i / nx + unit(random_bits(seed, kScatter, draw + 1))) * pitch_m;
      if (!space.holds(x, y)) continue;
      points.emplace_back(x, y);
      break;
    }
  }
}

void Roadmap::join_points(const FreeSpace& space, uint64_t seed) {
  ways_from.resize(points.size());
  for (size_t a = 0; a < points.size(); ++a) {
    std::vector<std::pair<uint64_t, size_t>> near;
    for (size_t b = 0; b < points.size(); ++b) {
      const double length_m = (points[b] - points[a]).norm();
      if (length_m < kShortest_m || length_m > kLongest_m) continue;
      near.emplace_back(random_bits(seed, kJoin, a * points.size() + b), b);
    }
    std::sort(near.begin(), near.end());
    for (const auto& [draw, b] : near) {
      if (ways_from[a].size() == kWaysFromPoint) break;
      if (!space.holds_line(points[a], points[b])) continue;
      const Eigen::Vector2d d = points[b] - points[a];
      Way way;
      way.from = static_cast<int>(a);
      way.to = static_cast<int>(b);
      way.length_m = d.norm();
      way.yaw_rad = std::atan2(d.y(), d.x());
      way.cost = cost_of(space, points[a], points[b]);
      ways_from[a].push_back(static_cast<int>(ways.size()));
      ways.push_back(std::move(way));
    }
  }
}

void Roadmap::find_turns(const FreeSpace& space, double min_radius_m) {
  for (Way& way : ways) {
    const Eigen::Vector2d& corner = points[static_cast<size_t>(way.to)];
    for (const int next : ways_from[static_cast<size_t>(way.to)]) {
      auto turn = turn_between(space, way, ways[static_cast<size_t>(next)], corner, min_radius_m);
      if (!turn) continue;
      turn->to = next;
      way.turns.push_back(*turn);
    }
  }
}

}  // namespace groundloop::sim
