#include "bench/runner/scenario_export.h"

#include <filesystem>

#include "sim/generate/realize.h"
#include "sim/world/world.h"
#include "slam/mapping/atomic_file.h"

namespace groundloop::bench {

std::vector<std::string> export_scenario(const sim::Scenario& asked, const std::string& folder) {
  sim::Scenario scenario = sim::realized(asked);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(Problem{folder, 0, "--export", error.message(), "a folder that can be written to"});
  const std::string stem = (std::filesystem::absolute(folder) / scenario.name).lexically_normal().string();
  std::vector<std::string> files;
  const auto write = [&](const std::string& file, const std::string& text) {
    slam::write_file_atomically(file, [&](std::ostream& out) { out << text; });
    files.push_back(file);
  };
  if (const auto world = sim::generated_text(scenario)) {
    write(stem + ".xml", *world);
    scenario.world = {stem + ".xml", std::nullopt};
  }
  write(stem + ".yaml", sim::to_yaml(scenario));
  return files;
}

}  // namespace groundloop::bench
