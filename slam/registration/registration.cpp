#include "slam/registration/registration.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "slam/types/counter_random.h"

namespace groundloop::slam {
namespace {

constexpr double kMinDepth_m = 0.01;
constexpr double kConverged = 1e-8;   // step length in metres and radians
constexpr double kNearEnough = 1e-6;  // of reprojection: a thousandth of a pixel, noise leaves hundreds
constexpr double kLeastPivot =
    1e-9;                         // of the information that is left of an unknown, relative to the largest
constexpr double kOutlier2 = 25;  // squared misfit in standard deviations that is no noise

}  // namespace

Pose weighted_rigid(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b,
                    const std::vector<double>& weight) {
  double total = 0;
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < a.size(); ++i) {
    total += weight[i];
    mean_a += weight[i] * a[i];
    mean_b += weight[i] * b[i];
  }
  mean_a /= total;
  mean_b /= total;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < a.size(); ++i) H += weight[i] * (a[i] - mean_a) * (b[i] - mean_b).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  Pose T_b_a = Pose::Identity();
  T_b_a.linear() = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  T_b_a.translation() = mean_b - T_b_a.linear() * mean_a;
  return T_b_a;
}

void Registration::align(const std::vector<PointPair>& pairs, const Pose& predicted_T_from_to, uint64_t seed,
                         RegistrationResult& result) {
  result.usable = false;
  result.T_from_to = predicted_T_from_to;
  result.covariance.setZero();
  result.inlier.assign(pairs.size(), 0);
  result.inliers = 0;
  result.residual_px = 0;
  result.iterations = 0;
  if (static_cast<int>(pairs.size()) < options_.min_inliers) {
    result.message =
        fmt::format("{} points tracked in both images, {} needed", pairs.size(), options_.min_inliers);
    return;
  }

  p_from_.resize(pairs.size());
  p_to_.resize(pairs.size());
  for (size_t i = 0; i < pairs.size(); ++i) {
    p_from_[i] = pairs[i].p_from;
    p_to_[i] = rig_.triangulate(pairs[i].uvu_to).value_or(Eigen::Vector3d(0, 0, 1e3));
  }

  Pose T_to_from = robust_start(pairs, predicted_T_from_to.inverse(), seed);
  result.iterations = options_.cost == RegistrationCost::kReprojection ? refine_reprojection(pairs, T_to_from)
                                                                       : refine_scalar(pairs, T_to_from);

  const double gate2 = options_.inlier_gate_px * options_.inlier_gate_px;
  double sum2 = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const double misfit2 = misfit2_px(pairs[i], T_to_from);
    if (misfit2 > gate2) continue;
    result.inlier[i] = 1;
    ++result.inliers;
    sum2 += misfit2;
  }
  result.T_from_to = T_to_from.inverse();
  const int needed = std::max(
      options_.min_inliers, static_cast<int>(options_.min_inlier_ratio * static_cast<double>(pairs.size())));
  if (result.inliers < needed) {
    result.message =
        fmt::format("{} of {} points agree on one motion, {} needed", result.inliers, pairs.size(), needed);
    return;
  }
  result.residual_px = std::sqrt(sum2 / (3.0 * result.inliers));

  if (!covariance(pairs, T_to_from, result.covariance)) {
    result.message = "the points do not determine the motion";
    return;
  }
  result.usable = true;
  result.message.clear();
}

double Registration::misfit2_px(const PointPair& pair, const Pose& T_to_from) const {
  const Eigen::Vector3d p_to = T_to_from * pair.p_from;
  if (p_to.z() < kMinDepth_m) return std::numeric_limits<double>::infinity();
  return (pair.uvu_to - rig_.project(p_to)).squaredNorm();
}

Pose Registration::robust_start(const std::vector<PointPair>& pairs, const Pose& predicted_T_to_from,
                                uint64_t seed) {
  const double gate2 = options_.inlier_gate_px * options_.inlier_gate_px;
  const auto score = [&](const Pose& T_to_from, double least) {
    // Truncated cost, so that of two motions with as many inliers the tighter one wins.
    double cost = 0;
    for (const PointPair& pair : pairs) {
      cost += std::min(misfit2_px(pair, T_to_from), gate2);
      if (cost > least) break;
    }
    return cost;
  };

  Pose best = predicted_T_to_from;
  double least = score(best, std::numeric_limits<double>::infinity());
  std::vector<Eigen::Vector3d>&a = sample_from_, &b = sample_to_;
  const auto n = static_cast<uint32_t>(pairs.size());
  for (int k = 0; k < options_.ransac_iterations; ++k) {
    uint32_t pick[3];
    for (int j = 0; j < 3; ++j) {
      pick[j] = random_index(random_bits(seed, static_cast<uint64_t>(j), static_cast<uint64_t>(k)), n);
      a[j] = p_from_[pick[j]];
      b[j] = p_to_[pick[j]];
    }
    if (pick[0] == pick[1] || pick[0] == pick[2] || pick[1] == pick[2]) continue;
    const double area = (a[1] - a[0]).cross(a[2] - a[0]).norm();
    if (area < 1e-2 * (a[1] - a[0]).norm() * (a[2] - a[0]).norm()) continue;
    const Pose candidate = weighted_rigid(a, b, equal_weights_);
    const double cost = score(candidate, least);
    if (cost < least) {
      least = cost;
      best = candidate;
    }
  }
  return best;
}

int Registration::refine_scalar(const std::vector<PointPair>& pairs, Pose& T_to_from) {
  const size_t n = pairs.size();
  const double fb = rig_.fx_px * rig_.baseline_m;
  variance_.resize(n);
  weight_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    // sigma_Z = Z^2 sigma_d / (f b), with sigma_d^2 = 2 sigma_px^2; the literal reading takes it at 3 m and
    // scales linearly from there. Only ratios matter to the minimum, but the Lorentzian's width depends on
    // the scale.
    const double sigma_d_px = std::sqrt(2.0) * options_.sigma_px * options_.lorentz_scale;
    const double z1 = p_from_[i].z(), z2 = p_to_[i].z();
    const auto sigma_m = [&](double z) {
      return options_.cost == RegistrationCost::kScalarQuadratic ? z * z * sigma_d_px / fb
                                                                 : z * 3.0 * sigma_d_px / fb;
    };
    variance_[i] = sigma_m(z1) * sigma_m(z1) + sigma_m(z2) * sigma_m(z2);
  }
  int iteration = 0;
  for (; iteration < options_.max_iterations; ++iteration) {
    for (size_t i = 0; i < n; ++i) {
      const double d2 = (p_to_[i] - T_to_from * p_from_[i]).squaredNorm();
      weight_[i] = 1 / (variance_[i] + d2);  // derivative of log(1 + d^2 / sigma^2)
    }
    const Pose next = weighted_rigid(p_from_, p_to_, weight_);
    const double change = se3_log(next * T_to_from.inverse()).norm();
    T_to_from = next;
    if (change < kConverged) break;
  }
  return iteration;
}

Matrix6d Registration::information(const std::vector<PointPair>& pairs, const Pose& T_to_from,
                                   Vector6d* gradient) const {
  Matrix6d H = Matrix6d::Zero();
  if (gradient != nullptr) gradient->setZero();
  const double variance_px2 = options_.sigma_px * options_.sigma_px;
  const double k2 = options_.lorentz_scale * options_.lorentz_scale;
  const Eigen::Matrix3d R = T_to_from.linear();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d p_to = T_to_from * pair.p_from;
    if (p_to.z() < kMinDepth_m) continue;
    const Eigen::Matrix3d J_p = projection_jacobian(rig_, p_to);
    const Eigen::Matrix3d J_R = J_p * R;
    Eigen::Matrix3d S = J_R * pair.covariance_from * J_R.transpose();
    S += variance_px2 * pair.cofactor_to;
    const Eigen::Matrix3d S_inverse = S.inverse();
    const Eigen::Vector3d d = pair.uvu_to - rig_.project(p_to);
    const double weight = 1 / (1 + d.dot(S_inverse * d) / k2);
    Eigen::Matrix<double, 3, 6> J;
    J.leftCols<3>() = J_p;
    J.rightCols<3>() = -J_p * skew(p_to);
    const Eigen::Matrix<double, 6, 3> JtW = J.transpose() * (weight * S_inverse);
    H.noalias() += JtW * J;
    if (gradient != nullptr) gradient->noalias() += JtW * d;
  }
  return H;
}

/// With W the weights as they came out, H = J^T W J and C the covariance of the misfits, the estimate follows
/// the noise as H^-1 J^T W noise: its covariance is H^-1 (J^T W C W J) H^-1. H^-1 alone would be half as
/// large again at a scale of 2, for it takes lowered weights for worse measurements. For the whole covariance
/// that is within two percent of the asymptotic one; for a scalar cost, whose noise lies along one axis, it
/// is an upper bound. J is by a left perturbation of T_to_from; seen from T_from_to it acts on the right with
/// the opposite sign, which leaves the covariance as it is.
bool Registration::covariance(const std::vector<PointPair>& pairs, const Pose& T_to_from,
                              Matrix6d& covariance) const {
  const bool scalar = options_.cost != RegistrationCost::kReprojection;
  const double variance_px2 = options_.sigma_px * options_.sigma_px;
  const double k2 = options_.lorentz_scale * options_.lorentz_scale;
  Matrix6d H = Matrix6d::Zero(), noise = Matrix6d::Zero();
  for (size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d p_to = T_to_from * pairs[i].p_from;
    if (p_to.z() < kMinDepth_m) continue;
    // Misfit d, its covariance C and weight W: of the image coordinates, or of the point itself.
    const Eigen::Matrix3d J_p = projection_jacobian(rig_, p_to);
    const Eigen::Matrix3d J_R = J_p * T_to_from.linear();
    Eigen::Matrix3d C = J_R * pairs[i].covariance_from * J_R.transpose();
    C += variance_px2 * pairs[i].cofactor_to;
    Eigen::Matrix3d J_d = J_p, C_inverse = C.inverse();
    Eigen::Vector3d d = pairs[i].uvu_to - rig_.project(p_to);
    const double s = d.dot(C_inverse * d);
    if (s > kOutlier2) C *= s / 3;  // not the stated noise
    Eigen::Matrix3d W = C_inverse / (1 + s / k2);
    if (scalar) {
      const Eigen::Matrix3d J_inverse = J_p.inverse();
      C = (J_inverse * C * J_inverse.transpose()).eval();
      J_d.setIdentity();
      W = Eigen::Matrix3d::Identity() / (variance_[i] + (p_to_[i] - p_to).squaredNorm());
    }
    Eigen::Matrix<double, 3, 6> J;
    J << J_d, -J_d * skew(p_to);
    const Eigen::Matrix<double, 6, 3> JtW = J.transpose() * W;
    H.noalias() += JtW * J;
    noise.noalias() += JtW * C * JtW.transpose();
  }
  const Eigen::LDLT<Matrix6d> ldlt(H);
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > kLeastPivot * ldlt.vectorD().maxCoeff()))
    return false;
  covariance = ldlt.solve(ldlt.solve(noise).transpose());
  return true;
}

int Registration::refine_reprojection(const std::vector<PointPair>& pairs, Pose& T_to_from) {
  int iteration = 0;
  for (; iteration < options_.max_iterations; ++iteration) {
    Vector6d gradient;
    const Matrix6d H = information(pairs, T_to_from, &gradient);
    const Vector6d step = H.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    T_to_from = se3_exp(step) * T_to_from;
    if (step.norm() < kNearEnough) break;
  }
  T_to_from = renormalised(T_to_from);
  return iteration;
}

}  // namespace groundloop::slam
