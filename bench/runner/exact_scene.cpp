#include "bench/runner/exact_scene.h"

namespace groundloop::bench {

sim::TruthWorld exact_scene(const sim::World& world) {
  const sim::World::DataPtr data = world.make_data();
  mj_forward(&world.model(), data.get());
  return sim::TruthWorld(world, *data);
}

std::vector<Footprint> scene_outline(const sim::TruthWorld& world) {
  std::vector<Footprint> outline;
  for (const sim::Outline& footprint : world.footprints(kBandMin_m, kBandMax_m)) {
    outline.push_back({footprint.name, footprint.polygon});
  }
  return outline;
}

}  // namespace groundloop::bench
