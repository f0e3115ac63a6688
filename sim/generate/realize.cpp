#include "sim/generate/realize.h"

#include "sim/generate/route.h"

namespace groundloop::sim {

Scenario realized(Scenario scenario, PictureContrast& pictures) {
  if (auto& recipe = scenario.world.generate) recipe->seed = recipe->seed.value_or(scenario.seed);
  if (!scenario.plan.generate) return scenario;
  scenario.plan.generate->seed = scenario.plan.generate->seed.value_or(scenario.seed);

  const World world = World::load(scenario, Looks::kNone);
  const World::DataPtr state = world.make_data();
  const TruthWorld truth(world, *state);
  const TextureSight sight(world, world_mjcf(scenario), truth, load_head(scenario.head.model), pictures);
  Route route = make_route(scenario, truth, sight);
  scenario.robot.start = route.start;
  scenario.plan.segments = std::move(route.segments);
  scenario.plan.generate.reset();
  return scenario;
}

Scenario realized(Scenario scenario) {
  PictureContrast pictures;
  return realized(std::move(scenario), pictures);
}

}  // namespace groundloop::sim
