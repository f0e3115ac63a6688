#include "sim/simulation/path_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/simulation/kidnapping.h"
#include "sim/world/walk.h"

namespace groundloop::sim {
namespace {

constexpr double kStep_m = 0.05;
constexpr double kStep_s = 0.1;
constexpr double kPersonDistance_m = 0.5;
constexpr double kPersonRadius_m = 0.25;
constexpr double kPersonCell_m = 0.05;
constexpr double kStep_rad = 3 * std::numbers::pi / 180;

Problem touches(const Scenario& scenario, const std::string& key, int line, const Pose2& at,
                const std::string& geom) {
  return {scenario.file, line, key, fmt::format("touches {} at x {:.2f} m, y {:.2f} m", geom, at.x_m, at.y_m),
          fmt::format("a place {} m clear of everything", kPathClearance_m)};
}

/// The plan's world after each kidnapping, for every point of the path.
class PlanCarrier {
 public:
  PlanCarrier(const Scenario& scenario, const PlannedPath& path) {
    for (const Fault& fault : kidnappings_of(scenario.faults)) {
      const PlannedState from = path.at(fault.at_s);
      legs_.push_back(
          {{from.segment, from.fraction}, composed(pose_of(*fault.kidnap), inverse(from.T_world_body))});
    }
  }

  Pose2 carried(size_t segment, double fraction, const Pose2& T_world_planned) const {
    Pose2 T_world_plan;
    for (const Leg& leg : legs_) {
      if (leg.from <= std::pair(segment, fraction)) T_world_plan = leg.T_world_plan;
    }
    return composed(T_world_plan, T_world_planned);
  }

 private:
  struct Leg {
    std::pair<size_t, double> from;  ///< segment, and fraction of it driven
    Pose2 T_world_plan;
  };
  std::vector<Leg> legs_;
};

std::optional<Problem> first_touch(const Scenario& scenario, const PlannedPath& path,
                                   const PlanCarrier& carrier, const TruthWorld& truth, size_t segment) {
  const double steps = std::ceil(std::max({std::abs(path.segment_length_m(segment)) / kStep_m,
                                           std::abs(path.segment_turn_rad(segment)) / kStep_rad, 1.0}));
  for (double step = 1; step <= steps; ++step) {
    const double fraction = step / steps;
    const Pose2 at = carrier.carried(segment, fraction, path.at_fraction(segment, fraction));
    if (const auto geom = truth.collision(at.x_m, at.y_m, at.yaw_rad, kPathClearance_m)) {
      return touches(scenario, fmt::format("plan.segments[{}]", segment),
                     scenario.plan.segments[segment].line, at, *geom);
    }
  }
  return std::nullopt;
}

std::optional<Problem> trouble_with(const Scenario& scenario, size_t index, const PlannedPath& path,
                                    const TruthWorld& truth) {
  const Fault& fault = scenario.faults[index];
  const std::string key = fmt::format("faults[{}]", index);
  if (fault.at_s > path.duration_s()) {
    return Problem{scenario.file, fault.line, key + ".at_s", fmt::format("{}", fault.at_s),
                   fmt::format("a time within the plan, which takes {:.2f} s", path.duration_s())};
  }
  if (!fault.kidnap) return std::nullopt;
  const Pose2 there = pose_of(*fault.kidnap);
  const auto geom = truth.collision(there.x_m, there.y_m, there.yaw_rad, kPathClearance_m);
  if (!geom) return std::nullopt;
  return touches(scenario, key + ".kidnap", fault.line, there, *geom);
}

/// Where the robot is meant to be at a time.
Pose2 planned_place(const PlannedPath& path, const PlanCarrier& carrier, double time_s) {
  const PlannedState planned = path.at(time_s);
  return carrier.carried(planned.segment, planned.fraction, planned.T_world_body);
}

std::optional<Problem> too_near(const Scenario& scenario, size_t index, const PlannedPath& path) {
  const PlanCarrier carrier(scenario, path);
  const Walk walk(scenario.people[index]);
  for (double time_s = 0; time_s <= path.duration_s(); time_s += kStep_s) {
    const Eigen::Vector2d p = walk.at(time_s).p_world;
    const Pose2 robot = planned_place(path, carrier, time_s);
    if (std::hypot(p.x() - robot.x_m, p.y() - robot.y_m) >= kPersonDistance_m) continue;
    return Problem{scenario.file, scenario.people[index].line, fmt::format("people[{}].way", index),
                   fmt::format("meets the robot at {:.1f} s, x {:.2f} m, y {:.2f} m", time_s, p.x(), p.y()),
                   fmt::format("a way that keeps {} m away from the robot", kPersonDistance_m)};
  }
  return std::nullopt;
}

std::optional<Problem> walks_into_something(const Scenario& scenario, size_t index, const TruthWorld& truth) {
  const Walk walk(scenario.people[index]);
  const slam::GridGeometry grid = truth.bounds(kPersonCell_m);
  const slam::OccupancyMap map = truth.occupancy(grid, 0.05, 1.75);
  const int reach = static_cast<int>(kPersonRadius_m / kPersonCell_m);
  for (double travelled_m = 0; travelled_m <= walk.length_m(); travelled_m += kPersonCell_m) {
    const Eigen::Vector2d p = walk.point(travelled_m);
    for (int row = grid.row_of(p.y()) - reach; row <= grid.row_of(p.y()) + reach; ++row) {
      for (int col = grid.col_of(p.x()) - reach; col <= grid.col_of(p.x()) + reach; ++col) {
        if (!grid.contains(col, row) || map.value[grid.index(col, row)] == 0) continue;
        return Problem{scenario.file, scenario.people[index].line, fmt::format("people[{}].way", index),
                       fmt::format("walks into something at x {:.2f} m, y {:.2f} m", p.x(), p.y()),
                       fmt::format("a way {} m clear of everything", kPersonRadius_m)};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

void check_people(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth) {
  std::vector<Problem> problems;
  for (size_t person = 0; person < scenario.people.size(); ++person) {
    if (auto problem = walks_into_something(scenario, person, truth)) problems.push_back(std::move(*problem));
    if (auto problem = too_near(scenario, person, path)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

void check_path(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth) {
  // Nothing that follows means much when the robot starts inside something.
  const Pose2 start = path.at(0).T_world_body;
  if (const auto geom = truth.collision(start.x_m, start.y_m, start.yaw_rad, kPathClearance_m)) {
    throw InputError(touches(scenario, "robot.start", scenario.robot.start.line, start, *geom));
  }
  std::vector<Problem> problems;
  const PlanCarrier carrier(scenario, path);
  for (size_t segment = 0; segment < path.segments(); ++segment) {
    if (auto problem = first_touch(scenario, path, carrier, truth, segment))
      problems.push_back(std::move(*problem));
  }
  for (size_t fault = 0; fault < scenario.faults.size(); ++fault) {
    if (auto problem = trouble_with(scenario, fault, path, truth)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace groundloop::sim
