#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/mapping/mapper.h"
#include "slam/pipeline/options.h"
#include "slam/types/frame_result.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/oracle.h"
#include "slam/types/stereo_frame.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// A key frame as the map keeps it.
struct KeyFrameRecord {
  int64_t index = 0;
  int64_t stamp_ns = 0;
  int segment = 0;
  Pose T_map_left = Pose::Identity();
  /// Motion from the key frame before, as odometry measured it: recognised places move T_map_left besides.
  /// Identity at the first of a segment.
  Pose T_previous_left = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_previous_left, right perturbation
  /// What it added to the map, known after finish(); none when newer key frames of its place replaced it.
  SharedObservations observations;
};

/// One point of the cloud.
struct CloudPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  float sigma_m = 0;  ///< standard deviation along its ray
  uint8_t grey = 0;
  int key_frame = 0;  ///< that added it, index into key_frames()
};

/// The SLAM core: stereo pairs in, pose of each and a map out. Knows nothing of where the pairs come from.
///
/// The map frame is the body frame at the first frame (x forward, y left, z up, origin on the floor), that is
/// T_map_left of frame 0 equals rig.T_body_left.
class Pipeline {
 public:
  /// @param oracle  exact answers in the place of a stage, for experiments; must outlive the pipeline
  Pipeline(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle = nullptr);
  ~Pipeline();

  /// Takes one pair. Losing track is a status, never an exception.
  /// @throws std::invalid_argument when the images are not 8-bit grey of the rig's size
  FrameResult process(const StereoFrame& frame);
  /// The same, into a result whose storage is reused.
  void process(const StereoFrame& frame, FrameResult& result);

  /// Completes the work in flight and draws the map where everything is now known to be. Call once after the
  /// last frame; map, layers and cloud are there after it.
  void finish();

  /// Left camera poses of every frame so far, with all corrections that have entered.
  const Trajectory& trajectory() const;
  const std::vector<KeyFrameRecord>& key_frames() const;
  std::vector<CloudPoint> cloud() const;
  /// Every link accepted so far, in the order in which they entered.
  const std::vector<LoopLink>& links() const;
  /// Global map of the whole height band.
  OccupancyMap map() const;
  /// Global maps by height layer, lowest first; boundaries are options().mapping.layer_heights_m.
  std::vector<OccupancyMap> layers() const;
  /// Dense disparity of the last key frame [half-resolution px * 16, CV_16SC1; negative: unknown].
  const cv::Mat& last_disparity() const;
  const SlamOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::slam
