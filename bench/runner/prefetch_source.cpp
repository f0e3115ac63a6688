#include "bench/runner/prefetch_source.h"

namespace groundloop::bench {

PrefetchSource::PrefetchSource(slam::StereoSource& source, size_t depth)
    : source_(source), depth_(depth), thread_([this] { produce(); }) {}

PrefetchSource::~PrefetchSource() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PrefetchSource::produce() {
  while (true) {
    std::optional<slam::StereoFrame> frame;
    std::exception_ptr error;
    try {
      frame = source_.next();
    } catch (...) {
      error = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    if (frame) {
      ready_.push_back(std::move(*frame));
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

std::optional<slam::StereoFrame> PrefetchSource::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ended_ || !ready_.empty(); });
  if (ready_.empty()) {
    if (error_) std::rethrow_exception(error_);
    return std::nullopt;
  }
  slam::StereoFrame frame = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  return frame;
}

}  // namespace groundloop::bench
