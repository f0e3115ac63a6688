#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/pipeline/pipeline.h"
#include "slam/types/stereo_frame.h"

namespace groundloop::bench {

/// Takes the two pictures of a run that need its images: features on the left image and the dense disparity,
/// both of the first key frame after two fifths of the run (or of the last one before, should there be none).
class FigureRecorder {
 public:
  FigureRecorder(const slam::StereoRig& rig, int64_t frames) : rig_(rig), wanted_(frames * 2 / 5) {}

  void observe(const slam::StereoFrame& frame, const slam::FrameResult& result, const slam::Pipeline& core);

  /// Writes left.png, left_tracked.png and disparity.png; nothing when there was no key frame.
  void write(const std::string& folder) const;

 private:
  slam::StereoRig rig_;
  int64_t wanted_;
  bool done_ = false;
  std::vector<std::vector<slam::FeatureObservation>> history_;
  std::vector<std::vector<slam::FeatureObservation>> history_taken_;
  std::vector<slam::FeatureObservation> features_;
  cv::Mat left_, disparity_;
};

}  // namespace groundloop::bench
