#include "slam/pipeline/background.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <vector>

namespace groundloop::slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class BackgroundWork : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Both, BackgroundWork, testing::Values(false, true),
                         [](const auto& tested) { return tested.param ? "Threaded" : "Inline"; });

TEST_P(BackgroundWork, EntersAtItsFrameAndInOrderHoweverLongItTakes) {
  Background<int> background(GetParam());
  int state = 0;  // of the jobs alone
  std::vector<std::pair<int64_t, int>> entered;
  for (int64_t frame = 0; frame < 12; ++frame) {
    background.collect(frame, [&](int result) { entered.emplace_back(frame, result); });
    if (frame % 3 != 0 || frame > 6) continue;
    background.submit(frame + 4, [&state, frame] {
      if (frame == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      state = 10 * state + static_cast<int>(frame);
      return state;
    });
  }
  EXPECT_THAT(entered, ElementsAre(std::pair(4, 0), std::pair(7, 3), std::pair(10, 36)));
}

TEST_P(BackgroundWork, WhatComesBeforeAnUrgentJobEntersWithItAtTheLatest) {
  Background<int> background(GetParam());
  std::vector<std::pair<int64_t, int>> entered;
  for (int64_t frame = 0; frame < 12; ++frame) {
    background.collect(frame, [&](int result) { entered.emplace_back(frame, result); });
    if (frame == 0) background.submit(3, [] { return 0; });
    if (frame == 1) background.submit(11, [] { return 1; });
    if (frame == 2) background.submit(5, [] { return 2; });
    if (frame == 4) background.submit(9, [] { return 4; });
  }
  EXPECT_THAT(entered, ElementsAre(std::pair(3, 0), std::pair(5, 1), std::pair(5, 2), std::pair(9, 4)));
}

TEST_P(BackgroundWork, AnErrorOfAJobLeavesWhereItsResultWouldEnter) {
  Background<int> background(GetParam());
  std::vector<int> entered;
  background.submit(1, []() -> int { throw std::runtime_error("no good"); });
  background.submit(1, [] { return 5; });
  background.collect(0, [&](int result) { entered.push_back(result); });
  EXPECT_THROW(background.collect(1, [&](int result) { entered.push_back(result); }), std::runtime_error);
  EXPECT_THAT(entered, IsEmpty());
  background.collect(1, [&](int result) { entered.push_back(result); });
  EXPECT_THAT(entered, ElementsAre(5));
}

TEST(BackgroundWorkThreaded, RunsBesideTheFramePathAndEndsWithoutItsUnbegunJobs) {
  std::atomic<bool> go = false;
  std::atomic<int> done = 0;
  {
    Background<int> background(true);
    background.submit(0, [&] {
      while (!go) std::this_thread::yield();
      return ++done;
    });
    EXPECT_EQ(done, 0);  // inline, this line would never be reached
    go = true;
    background.collect(0, [](int) {});
    EXPECT_EQ(done, 1);
    go = false;
    std::atomic<bool> begun = false;
    background.submit(9, [&] {
      begun = true;
      while (!go) std::this_thread::yield();
      return ++done;
    });
    for (int i = 0; i < 3; ++i) background.submit(9, [&] { return ++done; });
    while (!begun) std::this_thread::yield();
    std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      go = true;
    }).detach();
  }
  EXPECT_GE(done, 2);
  EXPECT_LE(done, 5);
}

}  // namespace
}  // namespace groundloop::slam
