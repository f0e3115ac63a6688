#include "bench/cli/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>

namespace groundloop::bench {
namespace {

// In a process of its own: the flag stays set, and a second signal ends the program.
TEST(InterruptDeathTest, TheFirstSignalSetsTheFlagAndTheSecondEnds) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const std::atomic<bool>& stop = stop_on_interrupt();
        const bool before = stop;
        std::raise(SIGINT);
        std::_Exit(!before && stop ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
  EXPECT_EXIT(
      {
        stop_on_interrupt();
        std::raise(SIGINT);
        std::raise(SIGINT);
        std::_Exit(0);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptDeathTest, TerminationCountsAsInterrupt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const std::atomic<bool>& stop = stop_on_interrupt();
        std::raise(SIGTERM);
        std::_Exit(stop ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace groundloop::bench
