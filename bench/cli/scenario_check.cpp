#include "bench/cli/scenario_check.h"

#include <optional>

#include "sim/head/head.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"
#include "slam/pipeline/options.h"

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

void check_core_options(const sim::Scenario& scenario, std::vector<Problem>& problems) {
  auto options = attempt(problems, [&] { return slam::preset(scenario.slam.preset); });
  if (!options) {
    problems.back().file = scenario.file;
    problems.back().line = scenario.slam.preset_line;
    return;
  }
  for (const auto& [key, value] : scenario.slam.set) {
    const auto line = scenario.slam.set_lines.find(key);
    set_by_key(*options, key, YAML::Node(value), scenario.file,
               line == scenario.slam.set_lines.end() ? 0 : line->second, problems);
  }
}

}  // namespace

std::vector<Problem> problems_of_scenario(const std::string& file) {
  std::vector<Problem> problems;
  const auto scenario = attempt(problems, [&] { return sim::load_scenario(file); });
  if (!scenario) return problems;
  check_core_options(*scenario, problems);
  const auto head = attempt(problems, [&] { return sim::load_head(scenario->head.model); });
  const auto world = attempt(problems, [&] { return sim::World::load(*scenario); });
  if (head && world) {
    attempt(problems, [&] { return sim::Simulation(*world, *head, *scenario).exposures(); });
  }
  return problems;
}

}  // namespace groundloop::bench
