#include "bench/runner/figure_recorder.h"

#include <opencv2/imgcodecs.hpp>

#include "bench/report/figures.h"
#include "bench/runner/priority.h"

namespace groundloop::bench {
namespace {

constexpr size_t kHistory = 8;

}  // namespace

void FigureRecorder::observe(const slam::StereoFrame& frame, const slam::FrameResult& result,
                             const slam::Pipeline& core) {
  if (done_) return;
  if (result.is_key_frame) {
    frame.left.copyTo(left_);
    core.last_disparity().copyTo(disparity_);
    features_ = result.features;
    history_taken_ = history_;
    done_ = frame.index >= wanted_;
  }
  if (done_) {
    writing_ = std::async(std::launch::async, [this] {
      stand_back();
      write();
    });
    return;
  }
  history_.push_back(result.features);
  if (history_.size() > kHistory) history_.erase(history_.begin());
}

void FigureRecorder::finish() {
  if (writing_.valid()) return writing_.get();
  if (!left_.empty()) write();
}

void FigureRecorder::write() const {
  cv::imwrite(folder_ + "/left.png", left_);
  cv::imwrite(folder_ + "/left_tracked.png", draw_tracked(left_, features_, history_taken_));
  cv::imwrite(folder_ + "/disparity.png", draw_disparity(disparity_, rig_));
}

}  // namespace groundloop::bench
