#include "bench/runner/ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>

namespace groundloop::bench {
namespace {

/// Counts from 0 to end - 1.
std::function<std::optional<int>()> counting_to(int end) {
  return [n = 0, end]() mutable -> std::optional<int> {
    if (n == end) return std::nullopt;
    return n++;
  };
}

TEST(Ahead, GivesEverythingInOrderAndThenNothing) {
  Ahead<int> ahead(counting_to(1000), 3);
  for (int expected = 0; expected < 1000; ++expected) ASSERT_EQ(ahead.next(), expected);
  EXPECT_EQ(ahead.next(), std::nullopt);
  EXPECT_EQ(ahead.next(), std::nullopt);
}

TEST(Ahead, MakesNoMoreThanItsDepth) {
  std::atomic<int> made = 0;
  Ahead<int> ahead([&]() -> std::optional<int> { return made++; }, 2);
  ASSERT_EQ(ahead.next(), 0);
  ASSERT_EQ(ahead.next(), 1);
  // Two taken, at most two ready and one in the making.
  EXPECT_LE(made.load(), 5);
}

TEST(Ahead, ErrorsReachTheTakerAfterWhatWasMadeBefore) {
  Ahead<int> ahead([n = 0]() mutable -> std::optional<int> {
    if (n == 2) throw std::runtime_error("no more film");
    return n++;
  });
  EXPECT_EQ(ahead.next(), 0);
  EXPECT_EQ(ahead.next(), 1);
  try {
    ahead.next();
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "no more film");
  }
}

TEST(Ahead, CanBeLeftBeforeTheEnd) {
  Ahead<int> ahead([]() -> std::optional<int> { return 7; });
  EXPECT_EQ(ahead.next(), 7);
}

TEST(Ahead, ChainedOnesEndTogether) {
  Ahead<int> first(counting_to(50), 2);
  Ahead<int> second(
      [&]() -> std::optional<int> {
        const auto n = first.next();
        return n ? std::optional(2 * *n) : std::nullopt;
      },
      2);
  for (int n = 0; n < 50; ++n) ASSERT_EQ(second.next(), 2 * n);
  EXPECT_EQ(second.next(), std::nullopt);
}

TEST(Ahead, WhatTheMakerOwnsDiesInItsThread) {
  struct Mark {
    std::thread::id* died;
    explicit Mark(std::thread::id* where) : died(where) {}
    Mark(const Mark&) = delete;
    Mark& operator=(const Mark&) = delete;
    ~Mark() { *died = std::this_thread::get_id(); }
  };
  std::thread::id made, died;
  {
    Ahead<int> ahead([&, mark = std::shared_ptr<Mark>()]() mutable -> std::optional<int> {
      if (mark) return std::nullopt;
      mark = std::make_shared<Mark>(&died);
      made = std::this_thread::get_id();
      return 1;
    });
    EXPECT_EQ(ahead.next(), 1);
    EXPECT_EQ(ahead.next(), std::nullopt);
  }
  EXPECT_EQ(made, died);
  EXPECT_NE(died, std::this_thread::get_id());
}

TEST(Ahead, AMakerThatWaitsIsReleasedAtTheEnd) {
  std::promise<void> released;
  std::future<void> wait = released.get_future();
  {
    Ahead<int> ahead(
        [&]() -> std::optional<int> {
          wait.wait();
          return std::nullopt;
        },
        4, [&] { released.set_value(); });
  }
  SUCCEED() << "the thread has ended";
}

}  // namespace
}  // namespace groundloop::bench
