#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <vector>

#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// Factors on the brightness of a scene's lights.
struct LightFactors {
  std::vector<float> light;  ///< by MuJoCo light id; empty: all 1
  float ambient = 1;         ///< on the light that is everywhere (MuJoCo's head-light)
};

/// The lamps of a scenario in time. A lamp's factors multiply.
class Lighting {
 public:
  /// @throws InputError when a light is named that the world does not have
  Lighting(const mjModel& model, const Scenario& scenario);
  LightFactors at(double time_s) const;

 private:
  struct Change {
    LightChange what;
    std::vector<int> lights;
    bool ambient;
  };
  float brightness(const LightChange& change, uint64_t stream, double time_s) const;

  size_t lights_;
  uint64_t seed_;
  std::vector<Change> changes_;
};

}  // namespace groundloop::sim
