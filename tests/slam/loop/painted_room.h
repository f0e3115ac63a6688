#pragma once

#include <vector>

#include "slam/features/detector.h"
#include "slam/loop/loop_detector.h"
#include "slam/types/stereo_rig.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {

/// A long room, 2.5 m high, whose walls, floor and ceiling are painted; key frames of it with known poses.
/// The frame `room` has z up and its origin on the floor.
class PaintedRoom {
 public:
  struct Look {
    double period_m = 0;                   ///< the paint repeats along x; 0: never
    std::vector<Eigen::Vector3d> posters;  ///< centres of copies of one picture, 1.2 m wide, on the far wall
  };
  PaintedRoom(uint64_t seed, Look look) : seed_(seed), look_(std::move(look)) {}
  explicit PaintedRoom(uint64_t seed) : PaintedRoom(seed, Look{}) {}

  static StereoRig rig();                  ///< 320 x 240 px
  static constexpr double kFarWall_m = 3;  ///< y of the wall that T_room_left(x, y, 90) looks at

  /// A level camera 1.2 m above the floor.
  static Pose T_room_left(double x_m, double y_m, double yaw_deg);

  /// What the core knows of a key frame there: images, disparity, landmarks.
  LoopKeyFrame key_frame(int64_t index, const Pose& T_room_left, const Light& light = {1, 0, 1.5, 0}) const;

 private:
  double paint(Eigen::Vector3d p_room) const;
  cv::Mat render(const Pose& T_room_camera, const Light& light) const;

  uint64_t seed_;
  Look look_;
  Texture walls_{seed_, 0.15, 1.0, 12}, picture_{4711, 0.12, 0.6, 12};
};

/// A key frame with landmarks found as the pipeline finds them.
LoopKeyFrame make_key_frame(const StereoRig& rig, int64_t index, const cv::Mat& left, const cv::Mat& right,
                            const DetectionOptions& detection);
/// A verifier, or detector, as the tests use it.
LoopVerifier make_verifier(const LoopOptions& options = {});
LoopDetector make_detector(const LoopOptions& options = {});
/// A key frame as the verifier takes it.
CurrentView current_view(const LoopKeyFrame& key_frame);

}  // namespace groundloop::slam
