#include "bench/runner/exact_scene.h"

namespace groundloop::bench {

namespace {

sim::World::DataPtr state_of(const sim::SceneMotion& motion, const sim::World& world) {
  sim::World::DataPtr state = world.make_data();
  mj_kinematics(&motion.model(), state.get());
  return state;
}

}  // namespace

sim::TruthWorld exact_scene(const sim::World& world) {
  const sim::World::DataPtr data = world.make_data();
  mj_forward(&world.model(), data.get());
  return sim::TruthWorld(world, *data);
}

SceneInTime::SceneInTime(const sim::World& world, const sim::Scenario& scenario)
    : motion_(world, scenario),
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

std::vector<Footprint> scene_outline(const sim::TruthWorld& world) {
  std::vector<Footprint> outline;
  for (const sim::Outline& footprint : world.footprints(kBandMin_m, kBandMax_m)) {
    outline.push_back({footprint.name, footprint.polygon});
  }
  return outline;
}

}  // namespace groundloop::bench
