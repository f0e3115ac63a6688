#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "bench/runner/priority.h"

namespace groundloop::bench {

/// Makes things in a thread of its own, some ahead of who takes them: physics, rendering and decoding go on
/// while the core works, and stand back behind it. The order, and every byte, stays the maker's; its errors
/// reach the caller of next().
template <class T>
class Ahead {
 public:
  /// @param make   gives the next thing, none at the end; called, and destroyed, in the thread
  /// @param depth  things made ahead at most
  /// @param release  makes a make() that waits for something return, so that the thread can end
  explicit Ahead(std::function<std::optional<T>()> make, size_t depth = 4, std::function<void()> release = {})
      : depth_(depth),
        release_(std::move(release)),
        thread_([this, mine = std::move(make)]() mutable { produce(std::move(mine)); }) {}

  /// Stops after the thing in the making.
  ~Ahead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    if (release_) release_();
    thread_.join();
  }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;

  std::optional<T> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ended_ || !ready_.empty(); });
    if (ready_.empty()) {
      if (error_) std::rethrow_exception(error_);
      return std::nullopt;
    }
    std::optional<T> thing = std::move(ready_.front());
    ready_.pop_front();
    changed_.notify_all();
    return thing;
  }

 private:
  void produce(std::function<std::optional<T>()> make) {
    stand_back();
    while (true) {
      std::optional<T> thing;
      std::exception_ptr error;
      try {
        thing = make();
      } catch (...) {
        error = std::current_exception();
        thing.reset();  // g++ 12 builds the result in place and forgets at -O2 that it was empty before the
                        // throw
      }
      std::unique_lock lock(mutex_);
      if (thing) {
        ready_.push_back(std::move(*thing));
        changed_.notify_all();
        changed_.wait(lock, [this] { return stopped_ || ready_.size() < depth_; });
        if (!stopped_) continue;
      }
      error_ = error;
      ended_ = true;
      changed_.notify_all();
      return;
    }
  }

  const size_t depth_;
  const std::function<void()> release_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> ready_;
  std::exception_ptr error_;
  bool ended_ = false;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace groundloop::bench
