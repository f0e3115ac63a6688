#pragma once

#include <chrono>

#include "slam/types/frame_result.h"

namespace groundloop::slam {

/// Measures the stages of one frame: each lap adds the time since the last one to a stage.
class StageClock {
 public:
  explicit StageClock(FrameResult& result) : result_(result), start_(Clock::now()), last_(start_) {}

  void lap(Stage stage) {
    const Clock::time_point now = Clock::now();
    result_.stage_ms[static_cast<size_t>(stage)] += milliseconds(now - last_);
    last_ = now;
  }
  /// Leaves the time since the last lap to no stage.
  void restart() { last_ = Clock::now(); }
  ~StageClock() { result_.total_ms = milliseconds(Clock::now() - start_); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  static double milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }

  FrameResult& result_;
  Clock::time_point start_, last_;
};

}  // namespace groundloop::slam
