#include "sim/simulation/path_check.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kStep_m = 0.05;
constexpr double kStep_rad = 3 * std::numbers::pi / 180;

Problem touches(const Scenario& scenario, const std::string& key, int line, const Pose2& at,
                const std::string& geom) {
  return {scenario.file, line, key, fmt::format("touches {} at x {:.2f} m, y {:.2f} m", geom, at.x_m, at.y_m),
          fmt::format("a place {} m clear of everything", kPathClearance_m)};
}

std::optional<Problem> first_touch(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth,
                                   size_t segment) {
  const double steps = std::ceil(std::max({std::abs(path.segment_length_m(segment)) / kStep_m,
                                           std::abs(path.segment_turn_rad(segment)) / kStep_rad, 1.0}));
  for (double step = 1; step <= steps; ++step) {
    const Pose2 at = path.at_fraction(segment, step / steps);
    if (const auto geom = truth.collision(at.x_m, at.y_m, at.yaw_rad, kPathClearance_m)) {
      return touches(scenario, fmt::format("plan.segments[{}]", segment),
                     scenario.plan.segments[segment].line, at, *geom);
    }
  }
  return std::nullopt;
}

}  // namespace

void check_path(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth) {
  // Nothing that follows means much when the robot starts inside something.
  const Pose2 start = path.at(0).T_world_body;
  if (const auto geom = truth.collision(start.x_m, start.y_m, start.yaw_rad, kPathClearance_m)) {
    throw InputError(touches(scenario, "robot.start", scenario.robot.start.line, start, *geom));
  }
  std::vector<Problem> problems;
  for (size_t segment = 0; segment < path.segments(); ++segment) {
    if (auto problem = first_touch(scenario, path, truth, segment)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace groundloop::sim
