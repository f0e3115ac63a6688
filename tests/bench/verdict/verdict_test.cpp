#include "bench/verdict/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace groundloop::bench {
namespace {

using testing::HasSubstr;

const Metrics kMeasured = {{"trajectory.ate_rmse_m", 0.07}, {"trajectory.lost_frames", 0}, {"map.f1", 0.8}};

sim::Expectations expecting(const std::map<std::string, sim::Expectation>& metrics,
                            const std::string& outcome = "tracked") {
  sim::Expectations expected;
  expected.outcome = outcome;
  expected.metrics = metrics;
  return expected;
}

Metrics with_lost(double frames) {
  Metrics measured = kMeasured;
  measured["trajectory.lost_frames"] = frames;
  return measured;
}

TEST(Judge, PassesWhenEveryBoundIsKept) {
  const Verdict verdict =
      judge(expecting({{"trajectory.ate_rmse_m", {{}, 0.15}}, {"map.f1", {0.6, {}}}}), kMeasured);
  EXPECT_EQ(verdict.outcome, Outcome::kPass);
  EXPECT_TRUE(verdict.passed());
  EXPECT_EQ(verdict.message, "met every expectation");
}

TEST(Judge, BoundsAreInclusive) {
  EXPECT_TRUE(judge(expecting({{"map.f1", {0.8, 0.8}}}), kMeasured).passed());
}

TEST(Judge, NamesEveryMetricThatFellShortWithValueAndBound) {
  const Verdict verdict =
      judge(expecting({{"trajectory.ate_rmse_m", {{}, 0.02}}, {"map.f1", {0.9, 1}}}), kMeasured);
  EXPECT_EQ(verdict.outcome, Outcome::kFellShort);
  ASSERT_EQ(verdict.shortfalls.size(), 2u);
  EXPECT_EQ(verdict.shortfalls[0].text(), "map.f1 is 0.8, expected from 0.9 to 1");
  EXPECT_EQ(verdict.shortfalls[1].text(), "trajectory.ate_rmse_m is 0.07, expected at most 0.02");
  EXPECT_EQ(verdict.message,
            "map.f1 is 0.8, expected from 0.9 to 1; trajectory.ate_rmse_m is 0.07, expected at most 0.02");
}

TEST(Judge, AMetricThatWasNotMeasuredFallsShort) {
  const Verdict verdict = judge(expecting({{"loop.recall", {0.5, {}}}}), kMeasured);
  ASSERT_EQ(verdict.shortfalls.size(), 1u);
  EXPECT_EQ(verdict.shortfalls[0].text(), "loop.recall was not measured, expected at least 0.5");
}

TEST(Judge, NotANumberFallsShort) {
  const Metrics broken = {{"map.f1", std::numeric_limits<double>::quiet_NaN()},
                          {"trajectory.lost_frames", 0}};
  EXPECT_EQ(judge(expecting({{"map.f1", {0, 1}}}), broken).outcome, Outcome::kFellShort);
}

TEST(Judge, ALostRunFallsShortWithoutBeingAsked) {
  const Verdict verdict = judge({}, with_lost(3));
  EXPECT_EQ(verdict.outcome, Outcome::kFellShort);
  EXPECT_EQ(verdict.message, "trajectory.lost_frames is 3, expected at most 0");
}

TEST(Judge, AScenarioMayAllowLostFrames) {
  const auto allowing = expecting({{"trajectory.lost_frames", {{}, 5}}});
  EXPECT_TRUE(judge(allowing, with_lost(3)).passed());
  EXPECT_FALSE(judge(allowing, with_lost(6)).passed());
}

TEST(Judge, AnExpectedFailurePassesWhenTheRunWasLost) {
  const Verdict verdict = judge(expecting({}, "lost"), with_lost(1));
  EXPECT_TRUE(verdict.passed());
  EXPECT_EQ(verdict.message, "lost track, as expected");
}

TEST(Judge, AnExpectedFailureThatWasTrackedFallsShort) {
  const Verdict verdict = judge(expecting({}, "lost"), with_lost(0));
  EXPECT_EQ(verdict.outcome, Outcome::kFellShort);
  EXPECT_EQ(verdict.message, "trajectory.lost_frames is 0, expected at least 1");
}

TEST(Judge, AnExpectedFailureStillKeepsItsOtherBounds) {
  const auto expected = expecting({{"map.f1", {0.9, {}}}}, "lost");
  EXPECT_EQ(judge(expected, with_lost(1)).message, "map.f1 is 0.8, expected at least 0.9");
}

TEST(Judge, ARunWithoutFramesFallsShort) {
  EXPECT_THAT(judge({}, {}).message, HasSubstr("trajectory.lost_frames was not measured"));
}

TEST(Verdict, StartsAsNotJudged) {
  const Verdict verdict;
  EXPECT_EQ(verdict.outcome, Outcome::kInternalError);
  EXPECT_EQ(verdict.message, "the run was not judged");
}

TEST(Verdict, OfAnExceptionKeepsItsText) {
  const Verdict verdict = bad_input(InputError(Problem{"lab.yaml", 4, "seed", "one", "a whole number"}));
  EXPECT_EQ(verdict.outcome, Outcome::kBadInput);
  EXPECT_EQ(verdict.message, "lab.yaml:4: seed: one: wanted a whole number");
  EXPECT_EQ(internal_error("oops").outcome, Outcome::kInternalError);
}

TEST(ExitCodes, AreThoseOfTheDesign) {
  EXPECT_EQ(exit_code(Outcome::kPass), 0);
  EXPECT_EQ(exit_code(Outcome::kFellShort), 1);
  EXPECT_EQ(exit_code(Outcome::kBadInput), 2);
  EXPECT_EQ(exit_code(Outcome::kInternalError), 3);
}

TEST(ExitCodes, OfSeveralRunsAreThatOfTheWorst) {
  const Verdict pass = judge({}, kMeasured);
  const Verdict short_of = judge({}, with_lost(1));
  EXPECT_EQ(worst({}), Outcome::kPass);
  EXPECT_EQ(worst({pass, pass}), Outcome::kPass);
  EXPECT_EQ(worst({pass, short_of, pass}), Outcome::kFellShort);
  EXPECT_EQ(worst({internal_error("oops"), short_of, pass}), Outcome::kInternalError);
}

}  // namespace
}  // namespace groundloop::bench
