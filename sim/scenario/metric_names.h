#pragma once

#include <array>

namespace groundloop::sim {

/// Every metric the bench computes, in the order of its tables. The same names stand in `expect:`,
/// metrics.json, JUnit and the report.
inline constexpr auto kMetricNames = std::to_array<const char*>({
    "trajectory.ate_rmse_m",
    "trajectory.ate_max_m",
    "trajectory.rpe_trans_percent",
    "trajectory.rpe_rot_deg_per_m",
    "trajectory.end_error_m",
    "trajectory.end_yaw_deg",
    "trajectory.length_m",
    "trajectory.lost_frames",
    "trajectory.completeness",
    "trajectory.drift_5m_percent",
    "trajectory.planar_rmse_m",
    "trajectory.planar_max_m",
    "tracking.interruptions",
    "tracking.relocalised_s",
    "tracking.silent_jumps",
    "tracking.row_offset_px",
    "tracking.right_late_s",
    "map.f1",
    "map.iou",
    "map.mcc",
    "map.precision",
    "map.recall",
    "map.false_free_m2",
    "map.wall_offset_mean_m",
    "map.wall_offset_p95_m",
    "map.brier",
    "map.with_true_poses.f1",
    "stage.disparity_rmse_px",
    "stage.stereo_outlier_fraction",
    "stage.track_rmse_px",
    "stage.track_outlier_fraction",
    "stage.point_rmse_m",
    "stage.registration_trans_m",
    "stage.registration_rot_deg",
    "uncertainty.nees_mean",
    "uncertainty.nees_samples",
    "loop.precision",
    "loop.recall",
    "loop.ate_before_m",
    "loop.ate_after_m",
    "timing.render_ms",
    "timing.slam_ms_median",
    "timing.slam_ms_p99",
    "timing.keyframe_ms_median",
    "timing.wall_s",
    "timing.realtime_factor",
    "peak_memory_mb",
});

}  // namespace groundloop::sim
