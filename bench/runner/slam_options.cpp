#include "bench/runner/slam_options.h"

namespace groundloop::bench {

slam::SlamOptions slam_options(const sim::Scenario& scenario) {
  std::vector<Problem> problems;
  slam::SlamOptions options;
  try {
    options = slam::preset(scenario.slam.preset);
  } catch (const InputError& error) {
    for (Problem problem : error.problems()) {
      problem.file = scenario.slam.preset_line > 0 ? scenario.file : "--set";
      problem.line = scenario.slam.preset_line;
      problems.push_back(problem);
    }
  }
  options.seed = scenario.seed;
  for (const auto& [key, value] : scenario.slam.set) {
    const auto line = scenario.slam.set_lines.find(key);
    const bool in_file = line != scenario.slam.set_lines.end() && line->second > 0;
    set_by_key(options, key, YAML::Load(value), in_file ? scenario.file : "--set", in_file ? line->second : 0,
               problems);
  }
  if (!problems.empty()) throw InputError(problems);
  return options;
}

slam::SlamOptions slam_options(const std::string& preset, const std::vector<sim::Override>& set) {
  slam::SlamOptions options = slam::preset(preset);
  std::vector<Problem> problems;
  for (const sim::Override& one : set)
    set_by_key(options, one.key, YAML::Load(one.value), "--set", 0, problems);
  if (!problems.empty()) throw InputError(problems);
  return options;
}

}  // namespace groundloop::bench
