#include "bench/metrics/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace groundloop::bench {

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

}  // namespace groundloop::bench
