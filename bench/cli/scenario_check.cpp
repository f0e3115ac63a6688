#include "bench/cli/scenario_check.h"

#include <optional>

#include "bench/runner/slam_options.h"
#include "sim/generate/realize.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/carried_head.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"

namespace groundloop::bench {
namespace {

/// What `make` gives, or none and its problems.
template <class Make>
auto attempt(std::vector<Problem>& problems, Make make) -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    return std::nullopt;
  }
}

}  // namespace

std::vector<Problem> problems_of_scenario(const std::string& file) {
  std::vector<Problem> problems;
  const auto scenario = attempt(problems, [&] { return sim::realized(sim::load_scenario(file)); });
  if (!scenario) return problems;
  attempt(problems, [&] { return slam_options(*scenario); });
  const auto head = attempt(problems, [&] { return sim::carried_head(*scenario); });
  const auto world = attempt(problems, [&] { return sim::World::load(*scenario); });
  if (head && world) {
    attempt(problems, [&] { return sim::Simulation(*world, *head, *scenario).exposures(); });
  }
  return problems;
}

}  // namespace groundloop::bench
