#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "slam/types/pose.h"

namespace groundloop::bench {

/// The core's poses on their way back to the steering, from the core's thread to that of the physics.
class PoseChannel {
 public:
  /// The pose of the next pair, in order; none when the core is lost.
  void put(std::optional<slam::Pose> T_map_left) {
    {
      const std::lock_guard lock(mutex_);
      poses_.push_back(std::move(T_map_left));
    }
    changed_.notify_all();
  }

  /// The pose of a pair, as soon as it is known; none when there is none, and when the channel is closed
  /// first.
  std::optional<slam::Pose> wait(int64_t pair) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || static_cast<size_t>(pair) < poses_.size(); });
    if (static_cast<size_t>(pair) >= poses_.size()) return std::nullopt;
    return poses_[static_cast<size_t>(pair)];
  }

  /// Nobody will put any more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::optional<slam::Pose>> poses_;
  bool closed_ = false;
};

}  // namespace groundloop::bench
