#pragma once

#include <mutex>
#include <optional>

#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// A scenario's world with all its looks, read when the first pair is rendered: decoding the textures takes
/// longer than everything else before a run.
class DressedWorld {
 public:
  explicit DressedWorld(const sim::Scenario& scenario) : scenario_(scenario) {}
  /// May be called from several threads.
  /// @throws InputError when a texture cannot be read
  const sim::World& get() {
    std::call_once(once_, [this] { world_.emplace(sim::World::load(scenario_)); });
    return *world_;
  }

 private:
  const sim::Scenario& scenario_;
  std::once_flag once_;
  std::optional<sim::World> world_;
};

}  // namespace groundloop::bench
