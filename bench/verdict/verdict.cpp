#include "bench/verdict/verdict.h"

#include <fmt/format.h>

#include <algorithm>

namespace groundloop::bench {
namespace {

constexpr const char* kLostFrames = "trajectory.lost_frames";

/// A NaN lies within no bounds.
bool within(double value, const sim::Expectation& bounds) {
  return (!bounds.min || value >= *bounds.min) && (!bounds.max || value <= *bounds.max) && value == value;
}

/// What the outcome says about lost frames, as bounds on their number.
std::optional<sim::Expectation> bounds_of_outcome(const sim::Expectations& expected) {
  if (expected.outcome == "lost") return sim::Expectation{1, std::nullopt};
  if (expected.metrics.count(kLostFrames) != 0) return std::nullopt;
  return sim::Expectation{std::nullopt, 0};
}

std::optional<Shortfall> shortfall(const std::string& metric, const sim::Expectation& bounds,
                                   const Metrics& measured) {
  const auto found = measured.find(metric);
  if (found == measured.end()) return Shortfall{metric, std::nullopt, bounds.min, bounds.max};
  if (within(found->second, bounds)) return std::nullopt;
  return Shortfall{metric, found->second, bounds.min, bounds.max};
}

std::string joined(const std::vector<Shortfall>& shortfalls) {
  std::string text;
  for (const Shortfall& missed : shortfalls) text += (text.empty() ? "" : "; ") + missed.text();
  return text;
}

}  // namespace

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kPass:
      return "pass";
    case Outcome::kFellShort:
      return "fell short";
    case Outcome::kBadInput:
      return "bad input";
    case Outcome::kInternalError:
      return "internal error";
  }
  return "";
}

std::string Shortfall::text() const {
  const std::string is = value ? fmt::format("is {:.6g}", *value) : "was not measured";
  std::string bounds;
  if (min && max)
    bounds = fmt::format("from {:.6g} to {:.6g}", *min, *max);
  else if (min)
    bounds = fmt::format("at least {:.6g}", *min);
  else if (max)
    bounds = fmt::format("at most {:.6g}", *max);
  else
    bounds = "a number";
  return fmt::format("{} {}, expected {}", metric, is, bounds);
}

Verdict judge(const sim::Expectations& expected, const Metrics& measured) {
  Verdict verdict{Outcome::kPass, {}, ""};
  const auto expect = [&](const std::string& metric, const sim::Expectation& bounds) {
    if (const auto missed = shortfall(metric, bounds, measured)) verdict.shortfalls.push_back(*missed);
  };
  if (const auto bounds = bounds_of_outcome(expected)) expect(kLostFrames, *bounds);
  for (const auto& [metric, bounds] : expected.metrics) expect(metric, bounds);
  std::stable_sort(verdict.shortfalls.begin(), verdict.shortfalls.end(),
                   [](const Shortfall& a, const Shortfall& b) { return a.metric < b.metric; });

  if (!verdict.shortfalls.empty()) {
    verdict.outcome = Outcome::kFellShort;
    verdict.message = joined(verdict.shortfalls);
  } else if (expected.outcome == "lost") {
    verdict.message = "lost track, as expected";
  } else {
    verdict.message = "met every expectation";
  }
  return verdict;
}

Verdict bad_input(const InputError& error) { return {Outcome::kBadInput, {}, error.what()}; }

Verdict internal_error(const std::string& message) { return {Outcome::kInternalError, {}, message}; }

Outcome worst(const std::vector<Verdict>& verdicts) {
  Outcome outcome = Outcome::kPass;
  for (const Verdict& verdict : verdicts) outcome = std::max(outcome, verdict.outcome);
  return outcome;
}

}  // namespace groundloop::bench
