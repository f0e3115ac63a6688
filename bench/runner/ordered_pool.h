#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "bench/runner/priority.h"

namespace groundloop::bench {

/// Several workers make things from orders, each in a thread of its own; the things come out in the order of
/// their orders, whoever made them. The threads stand back behind who takes the things. Errors reach the
/// caller of next() in the place of the thing that failed.
template <class Order, class T>
class OrderedPool {
 public:
  using Take = std::function<std::optional<Order>()>;
  using Make = std::function<T(Order)>;

  /// @param take     gives the next order, none at the end; one call at a time, from any worker
  /// @param workers  each makes a thing of its order; called, and destroyed, in a thread of its own
  /// @param depth    orders taken before the oldest thing was called for, at most
  /// @param release  makes a take() or worker that waits for something return, so that the threads can end
  OrderedPool(Take take, std::vector<Make> workers, size_t depth, std::function<void()> release = {})
      : take_(std::move(take)), depth_(depth), release_(std::move(release)) {
    for (Make& worker : workers) {
      threads_.emplace_back([this, make = std::move(worker)]() mutable { work(std::move(make)); });
    }
  }

  /// Stops after the things in the making.
  ~OrderedPool() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    if (release_) release_();
    for (std::thread& thread : threads_) thread.join();
  }
  OrderedPool(const OrderedPool&) = delete;
  OrderedPool& operator=(const OrderedPool&) = delete;

  std::optional<T> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ready_.contains(given_) || (end_ && given_ >= *end_); });
    if (!ready_.contains(given_)) return std::nullopt;
    if (ready_.at(given_).error) std::rethrow_exception(ready_.at(given_).error);
    std::optional<T> thing = std::move(ready_.at(given_).thing);
    ready_.erase(given_++);
    lock.unlock();
    changed_.notify_all();
    return thing;
  }

 private:
  struct Made {
    std::optional<T> thing;
    std::exception_ptr error;
  };

  void work(Make make) {
    stand_back();
    size_t index = 0;
    while (const std::optional<Order> order = next_order(index)) {
      Made made;
      try {
        made.thing.emplace(make(*order));
      } catch (...) {
        made.error = std::current_exception();
      }
      put(index, std::move(made));
    }
  }

  /// Waits for its turn and for room, then takes an order; none when there are no more.
  std::optional<Order> next_order(size_t& index) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || end_ || (!taking_ && taken_ < given_ + depth_); });
    if (stopped_ || end_) return std::nullopt;
    taking_ = true;
    lock.unlock();
    std::optional<Order> order;
    Made failed;
    try {
      order = take_();
    } catch (...) {
      failed.error = std::current_exception();
    }
    lock.lock();
    taking_ = false;
    if (order) {
      index = taken_++;
    } else {
      if (failed.error) ready_[taken_++] = std::move(failed);
      end_ = taken_;
    }
    lock.unlock();
    changed_.notify_all();
    return order;
  }

  void put(size_t index, Made made) {
    {
      const std::lock_guard lock(mutex_);
      ready_[index] = std::move(made);
    }
    changed_.notify_all();
  }

  const Take take_;
  const size_t depth_;
  const std::function<void()> release_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<size_t, Made> ready_;  ///< made and not yet given, by the number of the order
  size_t taken_ = 0;              ///< orders
  size_t given_ = 0;              ///< things
  bool taking_ = false;
  bool stopped_ = false;
  std::optional<size_t> end_;  ///< how many orders there were
  std::vector<std::thread> threads_;
};

}  // namespace groundloop::bench
