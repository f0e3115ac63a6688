#include "bench/runner/ordered_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>

namespace groundloop::bench {
namespace {

using Pool = OrderedPool<int, int>;

Pool::Take counting_to(int end) {
  return [n = 0, end]() mutable -> std::optional<int> {
    if (n == end) return std::nullopt;
    return n++;
  };
}

int squared(int n) { return n * n; }

TEST(OrderedPool, KeepsTheOrderWhoeverIsFaster) {
  const Pool::Make slow = [](int n) {
    std::this_thread::sleep_for(std::chrono::microseconds(200 * (n % 3)));
    return squared(n);
  };
  Pool pool(counting_to(300), {slow, squared, slow}, 5);
  for (int n = 0; n < 300; ++n) ASSERT_EQ(pool.next(), squared(n));
  EXPECT_EQ(pool.next(), std::nullopt);
  EXPECT_EQ(pool.next(), std::nullopt);
}

TEST(OrderedPool, EveryWorkerHasAThread) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  const Pool::Make noted = [&](int n) {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
    return n;
  };
  // One worker waits until the other has made something, so both must have worked.
  std::atomic<bool> other = false;
  const Pool::Make waiting = [&](int n) {
    while (!other) std::this_thread::yield();
    return noted(n);
  };
  const Pool::Make opening = [&](int n) {
    other = true;
    return noted(n);
  };
  Pool pool(counting_to(20), {waiting, opening}, 4);
  for (int n = 0; n < 20; ++n) ASSERT_EQ(pool.next(), n);
  EXPECT_GE(threads.size(), 1U);
  EXPECT_FALSE(threads.contains(std::this_thread::get_id()));
}

TEST(OrderedPool, TakesNoMoreOrdersThanItsDepth) {
  std::atomic<int> taken = 0;
  Pool pool([&]() -> std::optional<int> { return taken++; }, {squared, squared}, 3);
  ASSERT_EQ(pool.next(), 0);
  ASSERT_EQ(pool.next(), 1);
  EXPECT_LE(taken.load(), 2 + 3);
}

TEST(OrderedPool, ErrorsComeInTheirPlace) {
  const Pool::Make failing = [](int n) {
    if (n == 3) throw std::runtime_error("torn film");
    return n;
  };
  Pool pool(counting_to(10), {failing, failing}, 4);
  for (int n = 0; n < 3; ++n) ASSERT_EQ(pool.next(), n);
  EXPECT_THROW(pool.next(), std::runtime_error);
}

TEST(OrderedPool, ErrorsOfWhoGivesOrdersComeAfterTheLastThing) {
  const Pool::Take take = [n = 0]() mutable -> std::optional<int> {
    if (n == 2) throw std::runtime_error("no more orders");
    return n++;
  };
  Pool pool(take, {squared, squared}, 4);
  EXPECT_EQ(pool.next(), 0);
  EXPECT_EQ(pool.next(), 1);
  EXPECT_THROW(pool.next(), std::runtime_error);
}

TEST(OrderedPool, CanBeLeftBeforeTheEndAndReleasesWhoWaits) {
  std::atomic<bool> released = false;
  const Pool::Make waiting = [&](int n) {
    while (!released) std::this_thread::yield();
    return n;
  };
  {
    Pool pool([]() -> std::optional<int> { return 1; }, {waiting, waiting}, 2, [&] { released = true; });
  }
  EXPECT_TRUE(released);
}

}  // namespace
}  // namespace groundloop::bench
