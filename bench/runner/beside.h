#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "bench/runner/priority.h"

namespace groundloop::bench {

/// Works off what it is given in a thread of its own, in the order in which it was given, and stands back
/// behind who gives it. Who gives waits when too much has piled up.
template <class Job>
class Beside {
 public:
  /// @param work   called in the thread
  /// @param depth  jobs that may wait
  explicit Beside(std::function<void(Job)> work, size_t depth = 16)
      : work_(std::move(work)), depth_(depth), thread_([this] { run(); }) {}

  /// Jobs not begun yet are dropped.
  ~Beside() {
    {
      const std::lock_guard lock(mutex_);
      waiting_.clear();
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void give(Job job) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return error_ || waiting_.size() < depth_; });
    if (error_) return;  // finish() tells
    waiting_.push_back(std::move(job));
    changed_.notify_all();
  }

  /// Waits until everything is done; there must be no more after it. An error of the work leaves from here.
  void finish() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  void run() {
    stand_back();
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      Job job = std::move(waiting_.front());
      waiting_.pop_front();
      changed_.notify_all();
      lock.unlock();
      try {
        work_(std::move(job));
      } catch (...) {
        lock.lock();
        error_ = std::current_exception();
        waiting_.clear();
        changed_.notify_all();
        return;
      }
    }
  }

  const std::function<void(Job)> work_;
  const size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::exception_ptr error_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace groundloop::bench
