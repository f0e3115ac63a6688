#include "bench/runner/beside.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace groundloop::bench {
namespace {

TEST(Beside, DoesEverythingInOrderEvenWhenItPilesUp) {
  std::vector<int> given(1000), done;
  std::iota(given.begin(), given.end(), 0);
  Beside<int> beside([&done](int job) { done.push_back(job); }, 2);
  for (const int job : given) beside.give(job);
  beside.finish();
  EXPECT_EQ(done, given);
}

TEST(Beside, AnErrorEndsTheWorkAndIsToldAtTheEnd) {
  std::vector<int> done;
  Beside<int> beside(
      [&done](int job) {
        if (job == 3) throw std::runtime_error("three");
        done.push_back(job);
      },
      1);
  for (int job = 0; job < 100; ++job) beside.give(job);  // does not wait for room that never comes
  try {
    beside.finish();
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "three");
  }
  EXPECT_THAT(done, testing::ElementsAre(0, 1, 2));
}

TEST(Beside, LeftAloneItDropsWhatWaits) {
  std::mutex gate;
  gate.lock();
  int done = 0;
  {
    Beside<int> beside([&](int) {
      const std::lock_guard wait(gate);
      ++done;
    });
    for (int job = 0; job < 10; ++job) beside.give(job);
    gate.unlock();
  }
  EXPECT_LE(done, 10);
}

}  // namespace
}  // namespace groundloop::bench
