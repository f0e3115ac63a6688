#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace groundloop::sim {

inline const std::string kFloor = "<geom name='floor' type='plane' size='20 20 0.1'/>";

/// Writes a small world file and returns its name.
inline std::string write_world(const std::string& name, const std::string& worldbody) {
  const auto file = std::filesystem::temp_directory_path() / ("groundloop_simulation_" + name + ".xml");
  std::ofstream(file) << "<mujoco><worldbody>" << worldbody << "</worldbody></mujoco>";
  return file.string();
}

/// The Pioneer at the origin of a world, with a plan.
inline Scenario pioneer_in(const std::string& world_file, const std::string& plan_yaml) {
  const auto folder = std::filesystem::absolute("models");  // tests run in the source folder
  const auto file = std::filesystem::path(world_file).replace_extension(".yaml");
  std::ofstream(file) << "format: 1\nname: test\nworld: " << world_file
                      << "\nrobot: {model: " << (folder / "robots/p3dx.xml").string()
                      << "}\nhead: {model: " << (folder / "heads/sth_mdcs.yaml").string() << "}\nplan:\n"
                      << plan_yaml;
  return load_scenario(file.string());
}

}  // namespace groundloop::sim
