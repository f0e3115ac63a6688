#pragma once

#include <cstdint>
#include <future>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "slam/pipeline/pipeline.h"
#include "slam/types/stereo_frame.h"

namespace groundloop::bench {

/// Takes the two pictures of a run that need its images: features on the left image and the dense disparity,
/// both of the first key frame after two fifths of the run (or of the last one before, should there be none).
/// They are drawn beside what is left of the run.
class FigureRecorder {
 public:
  /// @param folder  where left.png, left_tracked.png and disparity.png go
  FigureRecorder(const slam::StereoRig& rig, int64_t frames, std::string folder)
      : rig_(rig), wanted_(frames * 2 / 5), folder_(std::move(folder)) {}

  void observe(const slam::StereoFrame& frame, const slam::FrameResult& result, const slam::Pipeline& core);

  /// After the last frame, once: the pictures are there after it; none when there was no key frame.
  void finish();

 private:
  void write() const;

  slam::StereoRig rig_;
  int64_t wanted_;
  std::string folder_;
  bool done_ = false;
  std::vector<std::vector<slam::FeatureObservation>> history_;
  std::vector<std::vector<slam::FeatureObservation>> history_taken_;
  std::vector<slam::FeatureObservation> features_;
  cv::Mat left_, disparity_;
  std::future<void> writing_;  ///< last, so that it ends before what it draws
};

}  // namespace groundloop::bench
