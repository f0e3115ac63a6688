#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "slam/source/stereo_source.h"

namespace groundloop::bench {

/// Runs another source in a thread of its own, some pairs ahead: rendering or decoding goes on while the core
/// works. The order, and every byte, stays the source's. Errors of the source reach the caller of next().
class PrefetchSource : public slam::StereoSource {
 public:
  /// @param depth  pairs made ahead at most
  explicit PrefetchSource(slam::StereoSource& source, size_t depth = 4);
  /// Stops after the pair in the making.
  ~PrefetchSource() override;

  const slam::StereoRig& rig() const override { return source_.rig(); }
  std::optional<int64_t> size() const override { return source_.size(); }
  std::optional<slam::StereoFrame> next() override;

 private:
  void produce();

  slam::StereoSource& source_;
  const size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<slam::StereoFrame> ready_;
  std::exception_ptr error_;
  bool ended_ = false;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace groundloop::bench
