#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "sim/scenario/scenario.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// A scenario of the arm among `geoms`, 20 mm between the images, with a plan as YAML in flow style.
inline Scenario arm_among(const std::string& name, const std::string& geoms, const std::string& plan) {
  const auto models = std::filesystem::absolute("models");  // tests run in the source folder
  const auto file = std::filesystem::temp_directory_path() / ("groundloop_arm_" + name + ".xml");
  std::ofstream(file) << "<mujoco><worldbody><geom name='table' type='box' size='2 2 0.02' pos='0 0 -0.02'/>"
                      << geoms << "</worldbody></mujoco>";
  const auto yaml = std::filesystem::path(file).replace_extension(".yaml");
  std::ofstream(yaml) << "format: 1\nname: test\nworld: " << file.string()
                      << "\nrobot: {model: " << (models / "robots/ur5e_xc55.xml").string()
                      << "}\nhead: {model: " << (models / "heads/xc55_20mm.yaml").string()
                      << "}\nplan: " << plan << "\n";
  return load_scenario(yaml.string());
}

/// What a call complains of; empty when it does not.
template <class Call>
std::vector<Problem> problems_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace groundloop::sim
