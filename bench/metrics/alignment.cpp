#include "bench/metrics/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace groundloop::bench {
namespace {

constexpr double kStraight = 0.02;  ///< spread across the line, relative to that along it

/// Root mean square spread of points along their three principal axes, largest first [m].
Eigen::Vector3d spread_m(const Eigen::Matrix3Xd& p) {
  const Eigen::Matrix3Xd centred = p.colwise() - p.rowwise().mean();
  const Eigen::Matrix3d covariance = centred * centred.transpose() / static_cast<double>(p.cols());
  return covariance.jacobiSvd().singularValues().cwiseSqrt();
}

/// Points at the ends of each pose's three axes, 3 x 3 N [m].
Eigen::Matrix3Xd axis_tips(const slam::Trajectory& poses, double length_m) {
  Eigen::Matrix3Xd tips(3, 3 * poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    tips.middleCols<3>(3 * static_cast<Eigen::Index>(i)) =
        (length_m * poses[i].T.linear()).colwise() + poses[i].T.translation();
  }
  return tips;
}

}  // namespace

Eigen::Matrix3Xd positions_of(const slam::Trajectory& poses) {
  Eigen::Matrix3Xd p(3, poses.size());
  for (size_t i = 0; i < poses.size(); ++i) p.col(static_cast<int>(i)) = poses[i].T.translation();
  return p;
}

Alignment align_points(const Eigen::Matrix3Xd& p_truth, const Eigen::Matrix3Xd& p_map, bool with_scale) {
  const auto n = static_cast<double>(p_truth.cols());
  const Eigen::Vector3d mean_truth = p_truth.rowwise().mean();  // Eq. (34), (35)
  const Eigen::Vector3d mean_map = p_map.rowwise().mean();
  const Eigen::Matrix3Xd centred_map = p_map.colwise() - mean_map;
  const Eigen::Matrix3d covariance =  // Eq. (38)
      (p_truth.colwise() - mean_truth) * centred_map.transpose() / n;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& d = svd.singularValues();

  // Eq. (43): the reflection is undone along the weakest axis
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;

  Alignment alignment;
  alignment.unique = d(1) > std::numeric_limits<double>::epsilon();
  const Eigen::Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();  // Eq. (40)
  const double variance_map = centred_map.squaredNorm() / n;                                // Eq. (36)
  if (with_scale && variance_map > 0) alignment.scale = d.dot(sign) / variance_map;         // Eq. (42)
  alignment.T_truth_map.linear() = R;
  alignment.T_truth_map.translation() = mean_truth - alignment.scale * R * mean_map;  // Eq. (41)
  return alignment;
}

Alignment align(PosePairs& pairs, AlignMode mode, std::optional<size_t> first_poses) {
  Alignment applied;
  if (mode == AlignMode::kNone || pairs.size() == 0) return applied;
  if (mode == AlignMode::kOrigin) {
    applied.T_truth_map = pairs.truth.front().T * pairs.estimate.front().T.inverse();
  } else {
    const auto n = static_cast<Eigen::Index>(std::min(first_poses.value_or(pairs.size()), pairs.size()));
    applied = align_points(positions_of(pairs.truth).leftCols(n), positions_of(pairs.estimate).leftCols(n),
                           mode != AlignMode::kSe3);
    if (mode == AlignMode::kScale) applied.T_truth_map.setIdentity();
  }
  for (slam::StampedPose& pose : pairs.estimate) {
    pose.T.translation() *= applied.scale;
    pose.T = applied.T_truth_map * pose.T;
  }
  return applied;
}

slam::Pose map_placement(const PosePairs& pairs) {
  if (pairs.size() == 0) return slam::Pose::Identity();
  const Eigen::Matrix3Xd p_truth = positions_of(pairs.truth), p_map = positions_of(pairs.estimate);
  const Eigen::Vector3d spread = spread_m(p_truth);
  if (spread[1] > kStraight * spread[0]) return align_points(p_truth, p_map, false).T_truth_map;
  const double length_m = spread[0] > 0 ? spread[0] : 1;
  return align_points(axis_tips(pairs.truth, length_m), axis_tips(pairs.estimate, length_m), false)
      .T_truth_map;
}

}  // namespace groundloop::bench
