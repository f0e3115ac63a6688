#pragma once

#include "slam/types/stereo_frame.h"
#include "slam/types/stereo_rig.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {

/// A painted room, 6 m x 5 m x 2.5 m, and a robot that drives an arc in it: pictures whose poses are known.
class BoxRoom {
 public:
  /// @param scale  of the image: 1 is 320 x 240
  explicit BoxRoom(int scale = 1);

  const StereoRig& rig() const { return rig_; }
  /// True pose of the left camera at a step of the arc, in the body frame of step 0: the map frame.
  Pose T_map_left(double step) const;
  /// The pair seen at a step, with sensor noise of its own. The plan is exact when asked for.
  /// @param before  the step of the frame before
  StereoFrame frame(int64_t index, double step, double before, bool with_plan = true) const;
  StereoFrame frame(int64_t index) const {
    return frame(index, static_cast<double>(index), static_cast<double>(index - 1));
  }
  /// What a covered lens sees.
  StereoFrame dark_frame(int64_t index) const;

 private:
  Pose T_world_body(double step) const;
  cv::Mat render(const Pose& T_world_camera, uint64_t seed) const;

  StereoRig rig_;
  Texture paint_{77, 0.12, 0.7, 16};
};

}  // namespace groundloop::slam
