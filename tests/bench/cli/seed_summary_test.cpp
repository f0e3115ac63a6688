#include "bench/cli/seed_summary.h"

#include <gtest/gtest.h>

namespace groundloop::bench {
namespace {

RunOutcome run(const std::string& name, uint64_t seed, double nees_mean, double samples) {
  RunOutcome outcome{name, seed, "", 0, {}, {}, {}};
  outcome.metrics = {{"uncertainty.nees_mean", nees_mean}, {"uncertainty.nees_samples", samples}};
  return outcome;
}

// Of 400 samples the mean has a standard deviation of sqrt(12 / 400) = 0.17.
TEST(SeedSummary, SaysWhetherCovariancesAreHonest) {
  EXPECT_EQ(seed_summary({run("lab", 1, 5.9, 100), run("lab", 2, 6.1, 300)}),
            "lab over 2 seeds: NEES 6.05 of 6, 95 % bounds 5.67 to 6.34 (400 key frames): inside\n");
  EXPECT_EQ(
      seed_summary({run("lab", 1, 6.4, 200), run("lab", 2, 6.4, 200)}),
      "lab over 2 seeds: NEES 6.40 of 6, 95 % bounds 5.67 to 6.34 (400 key frames): outside: too sure of "
      "itself\n");
  EXPECT_EQ(
      seed_summary({run("lab", 1, 4, 200), run("lab", 2, 4, 200)}),
      "lab over 2 seeds: NEES 4.00 of 6, 95 % bounds 5.67 to 6.34 (400 key frames): outside: too modest\n");
}

TEST(SeedSummary, SpeaksOfEveryScenarioThatHasSeveral) {
  EXPECT_EQ(seed_summary({}), "");
  EXPECT_EQ(seed_summary({run("lab", 1, 6, 200)}), "");
  RunOutcome lost{"hall", 2, "", 0, {}, {}, {}};  // measured nothing
  EXPECT_EQ(seed_summary({run("lab", 1, 6, 200), run("hall", 1, 6, 200), lost}), "");
  RunOutcome exact = run("lab", 2, 1, 200);  // another experiment
  exact.oracles = {slam::OracleStage::kMotion};
  EXPECT_EQ(seed_summary({run("lab", 1, 6, 200), exact}), "");
}

}  // namespace
}  // namespace groundloop::bench
