#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "slam/types/loop_link.h"
#include "slam/types/pose.h"

namespace groundloop::slam {

enum class TrackingStatus {
  kNotRun,    ///< nothing was processed
  kStarted,   ///< first frame of a segment: pose from the plan (identity for the first of all)
  kTracking,  ///< pose from vision
  kRepeated,  ///< the images of the frame before again: pose is the planned motion added to the last
  kLost       ///< vision gave no pose; the reported one is the planned motion added to the last
};
const char* name_of(TrackingStatus status);

/// The stages whose time is measured in every frame, in the order in which they run. From kAdjustment on they
/// run beside the frame path; their time is told by the frame at which their result enters and is no part of
/// FrameResult::total_ms.
enum class Stage {
  kPyramid,
  kTracking,
  kRegistration,
  kDetection,
  kDisparity,
  kStereo,
  kAdjustment,
  kLoop,
  kMapping,
  kCount
};
inline constexpr size_t kStageCount = static_cast<size_t>(Stage::kCount);
const char* name_of(Stage stage);

/// One feature as seen in one frame.
struct FeatureObservation {
  int64_t id = 0;  ///< the same number as long as the feature lives; never used again
  float u_left_px = 0;
  float v_left_px = 0;
  float u_right_px = 0;
  float v_right_px = 0;
  bool has_right = false;  ///< left-right matched in this frame
  bool is_new = false;     ///< detected in this frame
  bool is_inlier = false;  ///< agreed with the registered motion
};

/// What the core says of one frame.
struct FrameResult {
  int64_t index = -1;
  int64_t stamp_ns = 0;
  TrackingStatus status = TrackingStatus::kNotRun;
  std::string message;  ///< why, when the pose is not from vision; empty otherwise
  int segment = 0;      ///< rises by one at each recovery from lost
  bool is_key_frame = false;
  Pose T_map_left =
      Pose::Identity();  ///< pose as known at this frame; Pipeline::trajectory() holds corrected ones
  Matrix6d covariance =
      Matrix6d::Zero();  ///< of the motion since the last key frame, twist in the left camera

  int features_tracked = 0;
  int inliers = 0;
  double row_offset_px = 0;  ///< by which the right image was found to have slipped down, and moved back
  double right_late_s = 0;   ///< by which the right image was found to be late, and taken for so
  double residual_px = 0;    ///< rms reprojection error of the inliers

  std::vector<FeatureObservation> features;
  std::vector<LoopLink> links;                 ///< places recognised; they enter the estimate at this frame
  std::array<double, kStageCount> stage_ms{};  ///< wall time, not part of the determinism promise
  double total_ms = 0;
  uint64_t state_hash = 0;  ///< over pose and features: the first frame that differs names the divergence
};

}  // namespace groundloop::slam
