#include "bench/runner/slam_options.h"

#include <numbers>
#include <string_view>

namespace groundloop::bench {
namespace {

/// Multiplies every length among options: names end in their units, lengths in `_m`.
class LengthScaler {
 public:
  explicit LengthScaler(double factor) : factor_(factor) {}

  template <class T>
  void operator()(const char* key, T& value, const Field& = {}) {
    if constexpr (Visitable<T>) {
      value.visit(*this);
    } else if constexpr (std::is_same_v<T, double>) {
      if (std::string_view(key).ends_with("_m")) value *= factor_;
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      if (!std::string_view(key).ends_with("_m")) return;
      for (double& length_m : value) length_m *= factor_;
    }
  }

 private:
  double factor_;
};

void scale_lengths(slam::SlamOptions& options, double factor) {
  if (factor == 1) return;
  LengthScaler scaler(factor);
  options.visit(scaler);
}

/// An arm's repeatability is in its data sheet; both stops of a pair have it. What it comes out as is not
/// told.
void tell_repeatability(const sim::ArmErrors& arm, slam::AdjustmentOptions& options) {
  options.pair_sigma_m = std::numbers::sqrt2 * arm.repeatability_m;
  options.pair_sigma_deg = std::numbers::sqrt2 * arm.repeatability_deg;
}

}  // namespace

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
  scale_lengths(options, scenario.slam.scale);
  tell_repeatability(scenario.robot.arm, options.adjustment);
  for (const auto& [key, value] : scenario.slam.set) {
    const auto line = scenario.slam.set_lines.find(key);
    const bool in_file = line != scenario.slam.set_lines.end() && line->second > 0;
    set_by_key(options, key, YAML::Load(value), in_file ? scenario.file : "--set", in_file ? line->second : 0,
               problems);
  }
  if (!problems.empty()) throw InputError(problems);
  scale_lengths(options, scenario.scale);
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
