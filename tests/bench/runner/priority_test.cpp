#include "bench/runner/priority.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "bench/runner/ahead.h"

namespace groundloop::bench {
namespace {

int niceness() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(Priority, HoldsForTheThreadAndThoseItStarts) {
  const int mine = niceness();
  int stood_back = -1, child = -1, once_more = -1;
  std::thread([&] {
    stand_back();
    stood_back = niceness();
    std::thread([&] { child = niceness(); }).join();
    stand_back();
    once_more = niceness();
  }).join();
  EXPECT_EQ(stood_back, std::max(mine, 10));
  EXPECT_EQ(child, stood_back);
  EXPECT_EQ(once_more, stood_back);
  EXPECT_EQ(niceness(), mine);
}

TEST(Priority, WhatIsMadeAheadStandsBack) {
  Ahead<int> ahead([]() -> std::optional<int> { return niceness(); });
  EXPECT_EQ(ahead.next(), std::max(niceness(), 10));
}

}  // namespace
}  // namespace groundloop::bench
