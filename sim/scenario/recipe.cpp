#include "sim/scenario/recipe.h"

#include <fmt/format.h>

namespace groundloop::sim {
namespace {

struct Smallest {
  double x_m, y_m;
};

/// Smaller ones have no room for a robot beside the furniture, or in front of a door.
Smallest smallest(WorldStyle style) {
  switch (style) {
    case WorldStyle::kCorridor:
      return {8, 2.4};
    case WorldStyle::kDoorway:
      return {8, 4};
    default:
      return {6, 5};
  }
}

}  // namespace

void WorldRecipe::check(ConfigReader& reader) const {
  const auto [x_m, y_m] = smallest(style);
  const bool usable = size_m.empty() || (size_m.size() == 2 && size_m[0] >= x_m && size_m[1] >= y_m);
  if (!usable) {
    std::string given;
    for (const double size : size_m) given += fmt::format("{}{}", given.empty() ? "" : ", ", size);
    reader.problem("size_m", "[" + given + "]",
                   fmt::format("[x, y] of at least [{}, {}] for this style", x_m, y_m));
  }
}

}  // namespace groundloop::sim
