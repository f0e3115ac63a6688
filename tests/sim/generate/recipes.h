#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "sim/scenario/scenario.h"

namespace groundloop::sim {

/// Loads a scenario of the Pioneer with this world and plan (YAML in flow style).
inline Scenario scenario_with(const std::string& world, const std::string& plan) {
  const std::string file = (std::filesystem::temp_directory_path() / "asked.yaml").string();
  const auto models = std::filesystem::absolute("models");  // tests run in the source folder
  std::ofstream(file) << "format: 1\nname: test\nworld: " << world
                      << "\nrobot: {model: " << (models / "robots/p3dx.xml").string()
                      << "}\nhead: {model: " << (models / "heads/sth_mdcs.yaml").string() << "}\nplan: " << plan
                      << "\n";
  return load_scenario(file);
}

inline std::string textures() { return std::filesystem::absolute("models/generated").string(); }

}  // namespace groundloop::sim
