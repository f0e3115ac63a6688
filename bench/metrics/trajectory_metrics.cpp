#include "bench/metrics/trajectory_metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/metrics/alignment.h"
#include "bench/metrics/path.h"
#include "bench/metrics/pose_error.h"
#include "bench/metrics/statistics.h"

namespace groundloop::bench {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

/// Rotation about one axis, the other two left aside (twist of the swing-twist decomposition), in [0, pi].
double twist_angle_rad(const Eigen::Matrix3d& R, const Eigen::Vector3d& axis) {
  const Eigen::Quaterniond q(R);
  return 2 * std::atan2(std::abs(q.vec().dot(axis)), std::abs(q.w()));
}

}  // namespace

std::optional<Drift> drift(const PosePairs& pairs, const std::vector<double>& lengths_m) {
  const std::vector<double> path_m = travelled(pairs.truth);
  Drift sum;
  for (size_t i = 0; i < pairs.size(); ++i) {
    for (const double length_m : lengths_m) {
      const auto end = std::upper_bound(path_m.begin() + static_cast<std::ptrdiff_t>(i), path_m.end(),
                                        path_m[i] + length_m);
      if (end == path_m.end()) continue;
      const auto j = static_cast<size_t>(end - path_m.begin());
      const slam::Pose T_truth = pairs.truth[i].T.inverse() * pairs.truth[j].T;
      const slam::Pose T_estimate = pairs.estimate[i].T.inverse() * pairs.estimate[j].T;
      const slam::Pose E = T_estimate.inverse() * T_truth;
      sum.trans_percent += 100 * E.translation().norm() / length_m;
      sum.rot_deg_per_m += kDegPerRad * slam::rotation_angle_rad(E.linear()) / length_m;
      ++sum.sub_trajectories;
    }
  }
  if (sum.sub_trajectories == 0) return std::nullopt;
  sum.trans_percent /= static_cast<double>(sum.sub_trajectories);
  sum.rot_deg_per_m /= static_cast<double>(sum.sub_trajectories);
  return sum;
}

EndError end_error(const PosePairs& pairs, const Eigen::Vector3d& up_truth) {
  const slam::Pose T_truth_map = pairs.truth.front().T * pairs.estimate.front().T.inverse();
  const slam::Pose& T_truth_end = pairs.truth.back().T;
  const slam::Pose T_estimate_end = T_truth_map * pairs.estimate.back().T;
  const Eigen::Matrix3d R_error = T_truth_end.linear() * T_estimate_end.linear().transpose();
  return {(T_truth_end.translation() - T_estimate_end.translation()).norm(),
          kDegPerRad * twist_angle_rad(R_error, up_truth)};
}

Metrics trajectory_metrics(const PosePairs& pairs, const Eigen::Vector3d& up_truth) {
  Metrics metrics;
  if (pairs.size() == 0) return metrics;

  PosePairs aligned = pairs;
  align(aligned, AlignMode::kSe3);
  const Statistics ate = statistics(absolute_errors(aligned, PoseRelation::kTranslationPart));
  metrics["trajectory.ate_rmse_m"] = ate.rmse;
  metrics["trajectory.ate_max_m"] = ate.max;

  if (const auto kitti = drift(pairs, {1, 2, 3, 4, 5, 6, 7, 8})) {
    metrics["trajectory.rpe_trans_percent"] = kitti->trans_percent;
    metrics["trajectory.rpe_rot_deg_per_m"] = kitti->rot_deg_per_m;
  }
  if (const auto over_5m = drift(pairs, {5})) {
    metrics["trajectory.drift_5m_percent"] = over_5m->trans_percent;
  }

  const EndError end = end_error(pairs, up_truth);
  metrics["trajectory.end_error_m"] = end.distance_m;
  metrics["trajectory.end_yaw_deg"] = end.yaw_deg;
  metrics["trajectory.length_m"] = travelled(pairs.truth).back();
  return metrics;
}

Metrics tracking_metrics(const std::vector<slam::FrameResult>& frames) {
  if (frames.empty()) return {};
  const auto count = [&](slam::TrackingStatus status) {
    return static_cast<double>(std::count_if(frames.begin(), frames.end(),
                                             [&](const slam::FrameResult& f) { return f.status == status; }));
  };
  const auto latest = std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) {
    return std::abs(a.right_late_s) < std::abs(b.right_late_s);
  });
  const double first = frames.front().status == slam::TrackingStatus::kStarted ? 1 : 0;
  return {{"trajectory.lost_frames", count(slam::TrackingStatus::kLost)},
          {"trajectory.completeness",
           (count(slam::TrackingStatus::kTracking) + first) / static_cast<double>(frames.size())},
          {"tracking.row_offset_px", frames.back().row_offset_px},
          {"tracking.right_late_s", latest->right_late_s}};
}

}  // namespace groundloop::bench
