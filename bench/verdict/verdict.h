#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "sim/scenario/scenario.h"

namespace groundloop::bench {

/// How a run ended. The values are the exit codes of every program; the larger, the worse.
enum class Outcome {
  kPass = 0,
  kFellShort = 1,     ///< the SLAM missed an expectation
  kBadInput = 2,      ///< the scenario or an option is wrong: nothing was judged
  kInternalError = 3  ///< the bench itself failed: nothing was judged
};
const char* name_of(Outcome outcome);
/// The exit code of a program that ended so.
constexpr int exit_code(Outcome outcome) { return static_cast<int>(outcome); }

/// One expectation that was not met.
struct Shortfall {
  std::string metric;
  std::optional<double> value;  ///< none: expected, but not measured
  std::optional<double> min;    ///< the bounds that were set
  std::optional<double> max;

  /// "trajectory.ate_rmse_m is 0.21, expected at most 0.15"
  std::string text() const;
};

struct Verdict {
  Outcome outcome = Outcome::kInternalError;
  std::vector<Shortfall> shortfalls;  ///< of kFellShort, at least one; in the order of metric names
  std::string message = "the run was not judged";  ///< one line: why; of an error all its lines

  bool passed() const { return outcome == Outcome::kPass; }
};

/// Compares what was measured with what was expected. Every bound is inclusive; a metric that is expected but
/// not measured, or is not a number, falls short.
///
/// Losing track: `outcome: tracked` (the default) falls short when trajectory.lost_frames is above 0, unless
/// `expect` bounds that metric itself; `outcome: lost` is an expected failure and falls short unless it is
/// above 0.
Verdict judge(const sim::Expectations& expected, const Metrics& measured);

/// The verdict of a run that ended by an exception.
Verdict bad_input(const InputError& error);
Verdict internal_error(const std::string& message);

/// The worst of several outcomes; of none: pass.
Outcome worst(const std::vector<Verdict>& verdicts);

}  // namespace groundloop::bench
