// What a window's estimate is worth: WindowAdjustment::uncertainty() and what it is made of.
#include <algorithm>
#include <numbers>

#include "slam/adjustment/factor.h"
#include "slam/adjustment/relative_pose.h"
#include "slam/adjustment/window_adjustment.h"

namespace groundloop::slam {
namespace {

constexpr double kLeastVariance = 0.01;  // relative to the stated noise: images have rounded grey values
constexpr double kLeastSlope = 0.1;      // relative to the weights: by chance it may come out as nothing
constexpr int kPulls = 5;                // terms of the series in unbend()

/// Mean of part / whole.
template <class Part, class Whole>
double mean_share(const Part& part, const Whole& whole) {
  const auto informed = whole.array() > 0;
  const auto share = informed.select(part.array() / whole.array(), 0);
  return share.sum() / std::max<double>(1, static_cast<double>(informed.count()));
}

}  // namespace

/// The estimate follows the gradients as x = J^-1 sum g_j, with J the slope of their sum and g_j what
/// landmark j adds to it, its own position eliminated: the covariance is J^-1 (sum g_j g_j^T) J^-1, whatever
/// the noise of a landmark is and however alike its errors in several key frames are (Liang & Zeger,
/// "Longitudinal data analysis using generalized linear models", Biometrika 73, 1986). Of J only the size is
/// taken, relative to the information H of the weights: with few landmarks a direction of it may happen to be
/// flat.
bool WindowAdjustment::uncertainty(const AdjustmentProblem& problem, AdjustmentResult& result) {
  auto noise = noise_.topLeftCorner(unknowns_, unknowns_);
  auto covariance = covariance_.topLeftCorner(unknowns_, unknowns_);
  Eigen::Ref<Eigen::MatrixXd> H = H_.topLeftCorner(unknowns_, unknowns_);
  slope_.head(unknowns_).setZero();
  clear_equations();
  for (size_t j = 0; j < p_odom_.size(); ++j) {
    reduce(j, 0);
    add_landmark(j);
    add_slope(j);
  }
  const double size = std::max(kLeastSlope, mean_share(slope_.head(unknowns_), H.diagonal()));
  noise = kLeastVariance * H;
  H *= size;
  noise -= H;
  add_priors(problem);
  noise += H;  // the noise of a prior is the stated one

  const LowerFactor llt(H);
  if (llt.info() != Eigen::Success || !regular(H, diagonal_.head(unknowns_))) {
    result.message = "the observations do not determine the key frames";
    return false;
  }
  if (pairs_err()) sway_.setZero(unknowns_, 6 * static_cast<Eigen::Index>(unknown_.size()));
  covariance.setIdentity();
  llt.solveInPlace(covariance);
  for (size_t j = 0; j < p_odom_.size(); ++j) {
    reduce(j, 0);  // once more: the terms of all landmarks would take more room than time
    result.landmark_covariance[j] = landmark_covariance(j);
    add_noise(j);
    if (pairs_err()) add_sway(j);
  }
  if (pairs_err()) add_noise_of_pairs(size);
  noise.triangularView<Eigen::StrictlyUpper>() = noise.transpose();
  llt.solveInPlace(noise);
  covariance = noise.transpose();
  llt.solveInPlace(covariance);
  motion_covariances(result);
  return true;
}

/// Adds the diagonal of how the reduced gradient of a landmark changes with the poses. That is less than its
/// weights tell: w r has the slope w across a residual r and w (2 w - 1) along it.
void WindowAdjustment::add_slope(size_t landmark) {
  if (!determined_[landmark]) return;
  const double k2 = options_.lorentz_scale * options_.lorentz_scale;
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  const auto bend = [&](size_t n) { return 2 * weight_[n] * weight_[n] / k2; };
  Eigen::Matrix3d slope_ll = Eigen::Matrix3d::Zero(), inverse;
  for (size_t n = begin; n < end; ++n) {
    const ObservationTerms& t = terms_[n - begin];
    slope_ll += weight_[n] * t.H_ll - bend(n) * t.g_l * t.g_l.transpose();
  }
  if (!invert(slope_ll, inverse)) return;  // on the ridge between two of its observations
  for (size_t n = begin; n < end; ++n) {
    const int row = observations_[n].unknown;
    if (row < 0) continue;
    const ObservationTerms& t = terms_[n - begin];
    const Matrix63d slope_xl = weight_[n] * t.H_xl - bend(n) * t.g_x * t.g_l.transpose();
    slope_.segment<6>(row) += weight_[n] * t.H_xx.diagonal() - bend(n) * t.g_x.cwiseAbs2() -
                              (slope_xl * inverse).cwiseProduct(slope_xl).rowwise().sum();
  }
}

void WindowAdjustment::add_noise(size_t landmark) {
  if (!determined_[landmark]) return;
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  for (size_t n = begin; n < end; ++n) {
    const ObservationTerms& t = terms_[n - begin];
    pull_[n - begin] = weight_[n] * (t.g_x - t.H_xl * own_step_[landmark]);
  }
  unbend(landmark);
  for (size_t n = begin; n < end; ++n) {
    const int row = observations_[n].unknown;
    if (row < 0) continue;
    const Vector6d alike = options_.error_likeness * pull_[n - begin];
    for (size_t m = begin; m <= n; ++m) {
      const int column = observations_[m].unknown;
      if (column >= 0) noise_.block<6, 6>(row, column).noalias() += alike * pull_[m - begin].transpose();
    }
  }
}

/// The gradients g_j are those at the estimate, which has bent itself to them. What landmark j pulls at the
/// estimate made of the others is (I - H_j H^-1)^-1 g_j, with H_j its own reduced information: the sum of
/// (H_j H^-1)^i g_j (the jackknife; Bell & McCaffrey, "Bias reduction in standard errors for linear
/// regression with multi-stage samples", Survey Methodology 28, 2002). The series is cut short, and no term
/// may be larger than the one before: that bounds what a key frame that hangs on a single landmark is given.
void WindowAdjustment::unbend(size_t landmark) {
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  const auto free = [&](size_t n) { return observations_[n].unknown >= 0; };
  std::copy_n(pull_.begin(), end - begin, own_pull_.begin());
  double share = 1;
  for (int i = 0; i < kPulls; ++i) {
    Eigen::Vector3d at_landmark = Eigen::Vector3d::Zero();
    for (size_t n = begin; n < end; ++n) {
      Vector6d& moved = moved_[n - begin];
      moved.setZero();
      if (!free(n)) continue;
      for (size_t m = begin; m < end; ++m) {
        if (free(m))
          moved.noalias() +=
              covariance_.block<6, 6>(observations_[n].unknown, observations_[m].unknown) * pull_[m - begin];
      }
      at_landmark.noalias() += weight_[n] * terms_[n - begin].H_xl.transpose() * moved;
    }
    double energy = 0, next_energy = 0;
    for (size_t n = begin; n < end; ++n) {
      const Vector6d next = weight_[n] * terms_[n - begin].H_xx * moved_[n - begin] - gain_[n] * at_landmark;
      energy += moved_[n - begin].dot(pull_[n - begin]);
      next_energy += moved_[n - begin].dot(next);
      pull_[n - begin] = next;
    }
    if (i == 0 && next_energy > energy) share = energy / next_energy;
    for (size_t n = begin; n < end; ++n) pull_[n - begin] = own_pull_[n - begin] + share * pull_[n - begin];
  }
}

/// What all landmarks of a pair have in common when its right camera is not where it should be: each is
/// measured where that moves it to.
void WindowAdjustment::add_sway(size_t landmark) {
  if (!determined_[landmark]) return;
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  for (size_t m = begin; m < end; ++m) {
    const Pose& T_odom_left = T_odom_left_[static_cast<size_t>(observations_[m].key_frame)];
    const Eigen::Vector3d p_left = T_odom_left.inverse() * p_odom_[landmark];
    if (terms_[m - begin].H_ll.isZero()) continue;  // not in view
    const Matrix36d moved = weight_[m] * T_odom_left.linear() * moved_by_right_camera(rig_, p_left);
    const Eigen::Index column = 6 * observations_[m].key_frame;
    const Matrix36d at_landmark = terms_[m - begin].H_ll * moved;
    for (size_t n = begin; n < end; ++n) {
      const int row = observations_[n].unknown;
      if (row < 0) continue;
      auto sway = sway_.block<6, 6>(row, column);
      sway.noalias() -= gain_[n] * at_landmark;
      if (n == m) sway.noalias() += terms_[m - begin].H_xl * moved;
    }
  }
}

/// A shift that is common to many moves the robust gradients by their slope.
void WindowAdjustment::add_noise_of_pairs(double slope_size) {
  const double sigma_rad = options_.pair_sigma_deg * std::numbers::pi / 180;
  Vector6d deviation;
  deviation << Eigen::Vector3d::Constant(options_.pair_sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  for (Eigen::Index column = 0; column < sway_.cols(); column += 6)
    sway_.middleCols<6>(column) *= slope_size * deviation.asDiagonal();
  noise_.topLeftCorner(unknowns_, unknowns_).noalias() += sway_ * sway_.transpose();
}

Eigen::Matrix3d WindowAdjustment::landmark_covariance(size_t landmark) const {
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  const double gate = options_.outlier_sigmas * options_.outlier_sigmas;
  Eigen::Matrix3d noise_ll = Eigen::Matrix3d::Zero();
  for (size_t n = begin; n < end; ++n) {
    // An outlier's noise is not the stated one, but its misfit.
    noise_ll += weight_[n] * weight_[n] * (s_[n] > gate ? s_[n] / 3 : 1) * terms_[n - begin].H_ll;
  }
  return inverse_ll_[landmark] * noise_ll * inverse_ll_[landmark];
}

void WindowAdjustment::motion_covariances(AdjustmentResult& result) const {
  const auto block = [&](int row, int column) -> Matrix6d {
    if (row < 0 || column < 0) return Matrix6d::Zero();
    return covariance_.block<6, 6>(row, column);
  };
  for (size_t k = 1; k < unknown_.size(); ++k) {
    const int a = unknown_[k - 1], b = unknown_[k];
    if (a < 0 && b < 0) continue;
    const Pose T_a_b = T_odom_left_[k - 1].inverse() * T_odom_left_[k];
    result.motion_covariance[k] = small_sample_factor(static_cast<int>(k)) *
                                  relative_pose_covariance(T_a_b, block(a, a), block(a, b), block(b, b));
  }
}

/// A covariance out of n landmarks is itself uncertain, so that errors normalised by it come out larger than
/// chi-square in the mean, by (n - 1) / (n - 1 - 7) for six unknowns (Hotelling's T^2).
double WindowAdjustment::small_sample_factor(int key_frame) const {
  const double gate = options_.outlier_sigmas * options_.outlier_sigmas;
  double landmarks = 0;  // seen in both key frames
  for (size_t n = 1; n < observations_.size(); ++n) {
    const Observation &before = observations_[n - 1], &o = observations_[n];
    if (o.key_frame != key_frame || before.key_frame != key_frame - 1 || before.landmark != o.landmark)
      continue;
    if (s_[n - 1] <= gate && s_[n] <= gate) ++landmarks;
  }
  return (landmarks + 1) / std::max(1.0, landmarks - 6);
}

}  // namespace groundloop::slam
