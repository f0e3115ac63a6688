#include "bench/runner/exact_scene.h"

namespace groundloop::bench {

namespace {

sim::World::DataPtr state_of(const sim::SceneMotion& motion, const sim::World& world) {
  sim::World::DataPtr state = world.make_data();
  mj_kinematics(&motion.model(), state.get());
  return state;
}

}  // namespace

MapBand map_band(const sim::Scenario& scenario) {
  const double scale = scenario.slam.scale * scenario.scale;
  return {.min_m = 0.02 * scale, .max_m = 2.0 * scale, .sight_m = 8.0 * scale};
}

sim::TruthWorld exact_scene(const sim::World& world) {
  const sim::World::DataPtr data = world.make_data();
  mj_forward(&world.model(), data.get());
  return sim::TruthWorld(world, *data);
}

SceneInTime::SceneInTime(const sim::World& world, const sim::Scenario& scenario)
    : band_(map_band(scenario)),
      driven_(!scenario.plan.is_for_arm()),
      motion_(world, scenario),
      state_(state_of(motion_, world)),
      seen_(world, *state_, sim::People::kSeen),
      standing_(world, *state_) {}

bool SceneInTime::move_to(double time_s) {
  if (!motion_.anything_moves()) return false;
  const bool furniture = motion_.place(time_s);
  mj_kinematics(&motion_.model(), state_.get());
  seen_.move_to(*state_);
  if (furniture) standing_.move_to(*state_);
  return furniture;
}

std::vector<Footprint> scene_outline(const sim::TruthWorld& world, const MapBand& band) {
  std::vector<Footprint> outline;
  for (const sim::Outline& footprint : world.footprints(band.min_m, band.max_m)) {
    outline.push_back({footprint.name, footprint.polygon});
  }
  return outline;
}

}  // namespace groundloop::bench
