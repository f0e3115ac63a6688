#pragma once

#include <string>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::slam {

/// Every option of the core; YAML keys equal member names (`slam: {set: {tracking.max_features: 400}}`).
struct SlamOptions {
  template <class Archive>
  void visit(Archive&) {}
};

/// Names of the presets, in the order in which help shows them.
std::vector<std::string> preset_names();

/// @param name "paper" (the faithful method) or "default" (the best this project has)
/// @throws InputError naming the presets
SlamOptions preset(const std::string& name);

}  // namespace groundloop::slam
