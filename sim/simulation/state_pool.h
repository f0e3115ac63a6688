#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "sim/world/world.h"

namespace groundloop::sim {

/// Copies of a MuJoCo state for readers in other threads. A copy that is let go is used again, so a steady
/// stream of copies allocates nothing. Copies may outlive the pool.
class StatePool {
 public:
  explicit StatePool(const mjModel& model) : model_(model), shelf_(std::make_shared<Shelf>()) {}
  std::shared_ptr<mjData> copy(const mjData& state);

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<World::DataPtr> unused;
  };
  const mjModel& model_;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace groundloop::sim
