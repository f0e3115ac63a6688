#include "sim/faults/arrivals.h"

#include <gmock/gmock.h>

namespace groundloop::sim {
namespace {

using ::testing::ElementsAre;

constexpr int64_t kPeriod_ns = 100'000'000;  // 10 pairs a second

/// From exposure `first` on, for so many.
Fault over(int64_t first, int64_t count) {
  Fault fault;
  fault.at_s = static_cast<double>(first) / 10 - 0.05;
  fault.for_s = static_cast<double>(count) / 10;
  return fault;
}
Fault drop(int64_t first, int64_t count, double probability = 1) {
  Fault fault = over(first, count);
  fault.drop = PairFault{probability};
  return fault;
}
Fault duplicate(int64_t first, int64_t count) {
  Fault fault = over(first, count);
  fault.duplicate = PairFault{};
  return fault;
}
Fault late(int64_t first, int64_t count, int pairs) {
  Fault fault = over(first, count);
  fault.late = LateFault{pairs};
  return fault;
}

/// "stamp:images" of every pair that arrives, with "x" where it is swapped.
std::vector<std::string> texts(const std::vector<Fault>& faults, int64_t exposures, uint64_t seed = 1) {
  std::vector<std::string> result;
  for (const Arrival& a : arrivals(faults, seed, exposures, kPeriod_ns)) {
    result.push_back(std::to_string(a.exposure) + ":" + std::to_string(a.images_of) + (a.swapped ? "x" : ""));
  }
  return result;
}

TEST(Arrivals, WithoutFaultsEveryPairArrivesAsItIs) {
  EXPECT_THAT(texts({}, 3), ElementsAre("0:0", "1:1", "2:2"));
}

TEST(Arrivals, DroppedPairsAreMissing) {
  EXPECT_THAT(texts({drop(1, 2)}, 5), ElementsAre("0:0", "3:3", "4:4"));
}

TEST(Arrivals, ADuplicateHasTheImagesBeforeAndAStampOfItsOwn) {
  EXPECT_THAT(texts({duplicate(2, 2)}, 6), ElementsAre("0:0", "1:1", "2:1", "3:1", "4:4", "5:5"));
  EXPECT_THAT(texts({duplicate(0, 2)}, 4), ElementsAre("2:2", "3:3")) << "nothing to hand out yet";
  EXPECT_THAT(texts({drop(1, 1), duplicate(2, 1)}, 4), ElementsAre("0:0", "2:0", "3:3"))
      << "what was lost cannot come again";
}

TEST(Arrivals, LatePairsWaitFirstAndAreOvertakenAtTheEnd) {
  EXPECT_THAT(texts({late(2, 4, 2)}, 8), ElementsAre("0:0", "1:1", /* 2 and 3: nothing yet */ "4:2", "5:3",
                                                     /* 4, 5 overtaken */ "6:6", "7:7"));
  EXPECT_THAT(texts({late(0, 3, 1)}, 4), ElementsAre("1:0", "2:1", "3:3"));
  EXPECT_THAT(texts({late(1, 2, 5)}, 5), ElementsAre("0:0", "3:3", "4:4")) << "none came in time";
}

TEST(Arrivals, SwappedPairsSaySo) {
  Fault swap = over(1, 1);
  swap.swap = PairFault{};
  EXPECT_THAT(texts({swap}, 3), ElementsAre("0:0", "1:1x", "2:2"));
}

TEST(Arrivals, ProbabilityIsThatOfEachPairAndTheSeedDecidesWhich) {
  const std::vector<Fault> faults = {drop(0, 10000, 0.3)};
  const auto first = texts(faults, 10000, 1);
  EXPECT_NEAR(static_cast<double>(first.size()), 7000, 5 * 46) << "five standard deviations";
  EXPECT_EQ(texts(faults, 10000, 1), first);
  EXPECT_NE(texts(faults, 10000, 2), first);
  const auto both = texts({drop(0, 10000, 0.3), drop(0, 10000, 0.3)}, 10000, 1);
  EXPECT_NEAR(static_cast<double>(both.size()), 4900, 5 * 50) << "two faults strike each on its own";
}

TEST(Arrivals, WhatHappensToAPairDoesNotDependOnHowManyThereAre) {
  const std::vector<Fault> faults = {drop(0, 100, 0.5)};
  auto longer = texts(faults, 60);
  const auto shorter = texts(faults, 40);
  longer.resize(shorter.size());
  EXPECT_EQ(longer, shorter);
}

TEST(FaultLabel, NamesWhatWasActiveSinceThePairBefore) {
  Fault kidnap;
  kidnap.at_s = 0.5;
  kidnap.kidnap = KidnapFault{1, 2, 3};
  const std::vector<Fault> faults = {drop(1, 2), kidnap, drop(2, 1)};
  EXPECT_EQ(fault_label(faults, -1, 0), "");
  EXPECT_EQ(fault_label(faults, 0, 300'000'000), "drop") << "over at this stamp, but not all the time before";
  EXPECT_EQ(fault_label(faults, 300'000'000, 400'000'000), "");
  EXPECT_EQ(fault_label(faults, 400'000'000, 500'000'000), "kidnap");
  EXPECT_EQ(fault_label(faults, 500'000'000, 600'000'000), "");
  EXPECT_EQ(fault_label(faults, -1, 600'000'000), "drop+kidnap");
}

}  // namespace
}  // namespace groundloop::sim
