#include "bench/runner/preview.h"

#include <opencv2/imgcodecs.hpp>

#include "bench/report/preview.h"
#include "bench/runner/exact_scene.h"
#include "sim/generate/realize.h"
#include "sim/simulation/carried_head.h"
#include "slam/mapping/atomic_file.h"

namespace groundloop::bench {
namespace {

constexpr double kPathStep_s = 0.5;

PlanPose plan_pose(const slam::Pose& T_world_body) {
  return {T_world_body.translation().x(), T_world_body.translation().y(),
          slam::yaw_rad(T_world_body.linear())};
}

}  // namespace

cv::Mat preview_picture(const sim::TruthWorld& world, const MapBand& band,
                        const sim::Simulation& simulation) {
  std::vector<PlanPose> path;
  for (double t = 0; t < simulation.planned_duration_s(); t += kPathStep_s) {
    path.push_back(plan_pose(simulation.planned_T_world_body(t)));
  }
  path.push_back(plan_pose(simulation.planned_T_world_body(simulation.planned_duration_s())));
  return draw_preview(scene_outline(world, band), path, path.front());
}

std::string preview(const sim::Scenario& asked, const std::string& file) {
  const sim::Scenario scenario = sim::realized(asked);
  const sim::HeadModel head = sim::carried_head(scenario);
  const sim::World world = sim::World::load(scenario);
  const sim::Simulation simulation(world, head, scenario);
  const std::string out = file.empty() ? scenario.name + ".png" : file;
  std::vector<uint8_t> png;
  cv::imencode(".png", preview_picture(exact_scene(world), map_band(scenario), simulation), png);
  slam::write_file_atomically(out, [&](std::ostream& stream) {
    stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  });
  return out;
}

}  // namespace groundloop::bench
