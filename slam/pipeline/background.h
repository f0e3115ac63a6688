#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

namespace groundloop::slam {

/// Work beside the frame path whose results enter at a frame that is fixed by what is given out, and when.
///
/// One worker does the jobs one after another, in the order in which they were given; a result is taken when
/// its frame has come, and waited for if it is not there yet. So what the frame path sees does not depend on
/// how fast the worker is, nor on whether there is one: without a thread, a job is done at once by submit().
/// A job may keep state of its own, as nobody else runs at the same time.
template <class Result>
class Background {
 public:
  /// @param threaded  false: jobs are done in submit(), with the same results at the same frames
  explicit Background(bool threaded) {
    if (threaded) worker_ = std::thread([this] { work(); });
  }

  /// Jobs not begun yet are dropped.
  ~Background() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    if (worker_.joinable()) worker_.join();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// @param enters_at  frame at which collect() takes the result; those of jobs before do not enter later
  void submit(int64_t enters_at, std::function<Result()> job) {
    std::packaged_task<Result()> task(std::move(job));
    for (Pending& before : pending_) before.enters_at = std::min(before.enters_at, enters_at);
    pending_.push_back({enters_at, task.get_future()});
    if (!worker_.joinable()) return task();
    {
      const std::lock_guard lock(mutex_);
      todo_.push_back(std::move(task));
    }
    wake_.notify_one();
  }

  /// Gives every result due at this frame to `apply`, oldest first. An exception of a job leaves from here.
  template <class Apply>
  void collect(int64_t frame, Apply apply) {
    while (!pending_.empty() && pending_.front().enters_at <= frame) {
      std::future<Result> result = std::move(pending_.front().result);
      pending_.pop_front();
      apply(result.get());
    }
  }

 private:
  struct Pending {
    int64_t enters_at;
    std::future<Result> result;
  };

  void work() {
    for (;;) {
      std::packaged_task<Result()> task;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return stop_ || !todo_.empty(); });
        if (stop_) return;
        task = std::move(todo_.front());
        todo_.pop_front();
      }
      task();
    }
  }

  std::deque<Pending> pending_;  ///< of the frame path alone
  std::deque<std::packaged_task<Result()>> todo_;
  bool stop_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread worker_;
};

}  // namespace groundloop::slam
