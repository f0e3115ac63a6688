#include "sim/world/lighting.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kStream = 0x666c69636b6572;  // "flicker"

std::string names_of_lights(const mjModel& model) {
  std::string names = "all, ambient";
  for (int light = 0; light < model.nlight; ++light) {
    if (const char* name = mj_id2name(&model, mjOBJ_LIGHT, light)) names += std::string(", ") + name;
  }
  return names;
}

}  // namespace

Lighting::Lighting(const mjModel& model, const Scenario& scenario)
    : lights_(static_cast<size_t>(model.nlight)), seed_(scenario.seed) {
  std::vector<Problem> problems;
  for (size_t i = 0; i < scenario.lights.size(); ++i) {
    const LightChange& what = scenario.lights[i];
    Change change{what, {}, what.light == "ambient" || what.light == "all"};
    for (int light = 0; light < model.nlight; ++light) {
      const char* name = mj_id2name(&model, mjOBJ_LIGHT, light);
      if (what.light == "all" || (name != nullptr && what.light == name)) change.lights.push_back(light);
    }
    if (change.lights.empty() && !change.ambient) {
      problems.push_back({scenario.file, what.line, fmt::format("lights[{}].light", i), what.light,
                          "one of: " + names_of_lights(model)});
    }
    changes_.push_back(std::move(change));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

float Lighting::brightness(const LightChange& change, uint64_t stream, double time_s) const {
  if (!change.flicker) return static_cast<float>(change.factor);
  const auto slot = static_cast<uint64_t>(std::floor((time_s - change.at_s) * change.flicker->rate_hz));
  const double chance = static_cast<double>(random_bits(seed_, stream, slot) >> 11) * 0x1p-53;
  return static_cast<float>(change.factor * (1 - change.flicker->depth * chance));
}

LightFactors Lighting::at(double time_s) const {
  LightFactors factors;
  if (changes_.empty()) return factors;
  factors.light.assign(lights_, 1);
  for (size_t i = 0; i < changes_.size(); ++i) {
    const LightChange& what = changes_[i].what;
    const double end_s = what.for_s ? what.at_s + *what.for_s : std::numeric_limits<double>::infinity();
    if (time_s < what.at_s || time_s >= end_s) continue;
    const float factor = brightness(what, kStream + i, time_s);
    for (const int light : changes_[i].lights) factors.light[static_cast<size_t>(light)] *= factor;
    if (changes_[i].ambient) factors.ambient *= factor;
  }
  return factors;
}

}  // namespace groundloop::sim
