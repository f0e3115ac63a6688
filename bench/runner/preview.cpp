#include "bench/runner/preview.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "bench/report/preview.h"
#include "bench/runner/exact_scene.h"
#include "sim/generate/realize.h"
#include "sim/robot/pose2.h"
#include "sim/simulation/carried_head.h"
#include "sim/simulation/kidnapping.h"
#include "slam/mapping/atomic_file.h"

namespace groundloop::bench {
namespace {

constexpr double kPathStep_s = 0.1;

PlanPose plan_pose(const sim::Pose2& T_world_body) {
  return {T_world_body.x_m, T_world_body.y_m, T_world_body.yaw_rad};
}

/// The planned way, cut where the robot is carried off.
struct Way {
  std::vector<PlanPose> path;  ///< up to the first kidnapping
  std::vector<DrawnKidnapping> kidnappings;
};

Way way_of(const sim::Scenario& scenario, const sim::Simulation& simulation) {
  const auto planned = [&](double time_s) { return sim::to_pose2(simulation.planned_T_world_body(time_s)); };
  sim::Pose2 T_world_plan;
  const auto leg = [&](double from_s, double to_s) {
    std::vector<PlanPose> path;
    for (double t = from_s; t < to_s; t += kPathStep_s) {
      path.push_back(plan_pose(composed(T_world_plan, planned(t))));
    }
    path.push_back(plan_pose(composed(T_world_plan, planned(to_s))));
    return path;
  };
  const std::vector<sim::Fault> kidnappings = sim::kidnappings_of(scenario.faults);
  const auto end_s = [&](size_t next) {
    return next < kidnappings.size() ? kidnappings[next].at_s : simulation.planned_duration_s();
  };
  Way way{leg(0, end_s(0)), {}};
  for (size_t i = 0; i < kidnappings.size(); ++i) {
    const double at_s = kidnappings[i].at_s;
    const sim::Pose2 from = composed(T_world_plan, planned(at_s));
    T_world_plan = sim::carried(from, pose_of(*kidnappings[i].kidnap), T_world_plan);
    way.kidnappings.push_back({at_s, plan_pose(from), leg(at_s, end_s(i + 1))});
  }
  return way;
}

/// Whatever stands elsewhere in one outline than in the other; both of the same geoms.
DrawnMove moved_between(double at_s, const std::vector<Footprint>& before,
                        const std::vector<Footprint>& after) {
  DrawnMove move{at_s, {}, {}};
  for (size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (before[i].polygon == after[i].polygon) continue;
    move.from.push_back(before[i]);
    move.to.push_back(after[i]);
  }
  return move;
}

std::vector<DrawnWalk> walks_of(const sim::Scenario& scenario) {
  std::vector<DrawnWalk> walks;
  for (const sim::Person& person : scenario.people) {
    DrawnWalk& walk = walks.emplace_back(DrawnWalk{person.name, {}, person.back_and_forth});
    for (const sim::WayPoint& point : person.way) walk.way.emplace_back(point.x_m, point.y_m);
  }
  return walks;
}

}  // namespace

cv::Mat preview_picture(const sim::World& world, const sim::Scenario& scenario,
                        const sim::Simulation& simulation) {
  SceneInTime scene(world, scenario);
  const std::vector<Footprint> outline = scene_outline(scene.standing(), scene.band());
  Way way = way_of(scenario, simulation);
  DrawnEvents events{walks_of(scenario), {}, std::move(way.kidnappings)};
  std::vector<double> times_s;
  for (const sim::Move& move : scenario.moves) times_s.push_back(move.at_s);
  std::sort(times_s.begin(), times_s.end());
  std::vector<Footprint> before = outline;
  for (const double at_s : times_s) {
    if (!scene.move_to(at_s)) continue;  // of things moved at the same time the first call moves all
    std::vector<Footprint> after = scene_outline(scene.standing(), scene.band());
    events.moves.push_back(moved_between(at_s, before, after));
    before = std::move(after);
  }
  return draw_preview(outline, way.path, way.path.front(), events);
}

std::string preview(const sim::Scenario& asked, const std::string& file) {
  const sim::Scenario scenario = sim::realized(asked);
  const sim::HeadModel head = sim::carried_head(scenario);
  const sim::World world = sim::World::load(scenario);
  const sim::Simulation simulation(world, head, scenario);
  std::string out = file.empty() ? scenario.name + ".png" : file;
  std::vector<uint8_t> png;
  cv::imencode(".png", preview_picture(world, scenario, simulation), png);
  slam::write_file_atomically(out, [&](std::ostream& stream) {
    stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  });
  return out;
}

}  // namespace groundloop::bench
