#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bench/metrics/association.h"
#include "bench/metrics/metrics.h"
#include "slam/types/frame_result.h"

namespace groundloop::bench {

/// How far an estimate drifts over pieces of the path, as KITTI's development kit counts it.
struct Drift {
  double trans_percent = 0;     ///< mean translation error by length of the piece
  double rot_deg_per_m = 0;     ///< mean rotation error by length of the piece
  size_t sub_trajectories = 0;  ///< how many pieces the means are over
};

/// Means over all sub-trajectories that start at every pose and end at the first pose whose path from there
/// exceeds one of the lengths. None when the path is shorter than every length.
/// @param lengths_m  each positive
/// @see Geiger, Lenz & Urtasun, CVPR 2012, section 3.1
std::optional<Drift> drift(const PosePairs& pairs, const std::vector<double>& lengths_m);

/// Where the estimate ends when its first pose is laid on the true one.
struct EndError {
  double distance_m = 0;
  double yaw_deg = 0;  ///< rotation about the vertical, absolute value, in [0, 180]
};

/// @param up_truth  the vertical in the truth's frame, unit length
EndError end_error(const PosePairs& pairs, const Eigen::Vector3d& up_truth);

/// trajectory.*: ate_rmse_m, ate_max_m (aligned by SE(3), no scale), rpe_trans_percent and rpe_rot_deg_per_m
/// (over 1, 2 .. 8 m), drift_5m_percent (over 5 m), end_error_m, end_yaw_deg, length_m (of the true path).
/// Those for which the path is too short are left out. No pairs: empty.
Metrics trajectory_metrics(const PosePairs& pairs,
                           const Eigen::Vector3d& up_truth = Eigen::Vector3d::UnitZ());

/// What the core says of its tracking: trajectory.lost_frames (frames with status lost),
/// trajectory.completeness (the part of the frames whose pose came from vision, or that started the first
/// segment, in [0, 1]), tracking.row_offset_px (by which the right image was moved back at the end) and
/// tracking.right_late_s (by which it was taken for late, where that was most). No frames: empty.
Metrics tracking_metrics(const std::vector<slam::FrameResult>& frames);

}  // namespace groundloop::bench
