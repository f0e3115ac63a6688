#include "slam/adjustment/window_adjustment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slam/adjustment/factor.h"
#include "slam/adjustment/relative_pose.h"

namespace groundloop::slam {
namespace {

constexpr double kFirstDamping = 1e-6, kLeastDamping = 1e-12, kMostDamping = 1e6;
constexpr double kConverged = 1e-12;  // decrease of the cost, relative to it

}  // namespace

Matrix6d planned_motion_covariance(const Pose& T_from_to, double plan_sigma_ratio) {
  const double degree = std::numbers::pi / 180;
  const double sigma_m = 1e-3 + plan_sigma_ratio * T_from_to.translation().norm();
  const double sigma_rad = 0.05 * degree + plan_sigma_ratio * rotation_angle_rad(T_from_to.linear());
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variance.asDiagonal();
}

void WindowAdjustment::solve(const AdjustmentProblem& problem, AdjustmentResult& result) {
  result.usable = false;
  result.message.clear();
  result.T_odom_left.clear();
  for (const AdjustmentKeyFrame& frame : problem.key_frames) result.T_odom_left.push_back(frame.T_odom_left);
  result.landmarks_odom = problem.landmarks_odom;
  result.inlier.assign(problem.observations.size(), 0);
  result.inliers = 0;
  result.landmark_covariance.assign(problem.landmarks_odom.size(), Eigen::Matrix3d::Zero());
  result.motion_covariance.assign(problem.key_frames.size(), Matrix6d::Zero());
  result.cost_before = result.cost_after = 0;
  result.iterations = 0;

  if (!prepare(problem, result.message)) return;
  if (!minimise(problem, result)) return;
  if (!uncertainty(problem, result)) return;
  judge_observations(result);
  result.T_odom_left = T_odom_left_;
  result.landmarks_odom = p_odom_;
  result.usable = true;
}

bool WindowAdjustment::prepare(const AdjustmentProblem& problem, std::string& message) {
  unknown_.clear();
  unknowns_ = 0;
  T_odom_left_.clear();
  for (const AdjustmentKeyFrame& frame : problem.key_frames) {
    T_odom_left_.push_back(frame.T_odom_left);
    unknown_.push_back(frame.fixed ? -1 : static_cast<int>(unknowns_));
    if (!frame.fixed) unknowns_ += 6;
  }
  p_odom_ = problem.landmarks_odom;
  if (unknowns_ == 0) {
    message = problem.key_frames.empty() ? "no key frame" : "every key frame is fixed";
    return false;
  }
  if (unknowns_ == 6 * static_cast<Eigen::Index>(unknown_.size())) {
    message = "no key frame is fixed";
    return false;
  }
  for (size_t i = 0; i < problem.motions.size(); ++i) {
    const int from = problem.motions[i].from, to = problem.motions[i].to,
              frames = static_cast<int>(unknown_.size());
    if (from >= 0 && from < frames && to >= 0 && to < frames && from != to) continue;
    message = fmt::format("motion {} leads from key frame {} to key frame {} of {}", i, from, to, frames);
    return false;
  }
  if (!sort_observations(problem, message) || !connected(problem, message)) return false;

  const size_t observations = observations_.size(), landmarks = p_odom_.size();
  weight_.resize(observations);
  s_.resize(observations);
  gain_.resize(observations);
  determined_.assign(landmarks, 1);
  inverse_ll_.resize(landmarks);
  own_step_.resize(landmarks);
  terms_.resize(unknown_.size());
  pull_.resize(unknown_.size());
  own_pull_.resize(unknown_.size());
  moved_.resize(unknown_.size());
  if (H_.rows() < unknowns_) {
    H_.resize(unknowns_, unknowns_);
    noise_.resize(unknowns_, unknowns_);
    covariance_.resize(unknowns_, unknowns_);
    g_.resize(unknowns_);
    diagonal_.resize(unknowns_);
    slope_.resize(unknowns_);
  }
  return true;
}

bool WindowAdjustment::sort_observations(const AdjustmentProblem& problem, std::string& message) {
  const int frames = static_cast<int>(problem.key_frames.size());
  const int landmarks = static_cast<int>(problem.landmarks_odom.size());
  observations_.clear();
  first_.assign(static_cast<size_t>(landmarks) + 1, 0);
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    const AdjustmentObservation& in = problem.observations[i];
    if (in.key_frame < 0 || in.key_frame >= frames || in.landmark < 0 || in.landmark >= landmarks) {
      message = fmt::format("observation {} names key frame {} of {}, landmark {} of {}", i, in.key_frame,
                            frames, in.landmark, landmarks);
      return false;
    }
    if (!(in.sigma_px > 0) || !in.uvu_px.allFinite()) {
      message = fmt::format("observation {} has a sigma of {} px at ({}, {}, {})", i, in.sigma_px,
                            in.uvu_px.x(), in.uvu_px.y(), in.uvu_px.z());
      return false;
    }
    Eigen::Matrix3d information;
    if (!invert(in.sigma_px * in.sigma_px * in.cofactor, information)) {
      message = fmt::format("observation {} has a cofactor that is no covariance", i);
      return false;
    }
    observations_.push_back({in.uvu_px, information, in.landmark, in.key_frame,
                             unknown_[static_cast<size_t>(in.key_frame)], static_cast<int>(i)});
    ++first_[static_cast<size_t>(in.landmark) + 1];
  }
  for (size_t j = 1; j < first_.size(); ++j) first_[j] += first_[j - 1];
  const auto order = [](const Observation& o) { return std::pair(o.landmark, o.key_frame); };
  std::sort(observations_.begin(), observations_.end(),
            [&](const Observation& a, const Observation& b) { return order(a) < order(b); });
  for (size_t n = 1; n < observations_.size(); ++n) {
    if (order(observations_[n - 1]) != order(observations_[n])) continue;
    message = fmt::format("landmark {} is observed twice in key frame {}", observations_[n].landmark,
                          observations_[n].key_frame);
    return false;
  }
  return true;
}

bool WindowAdjustment::connected(const AdjustmentProblem& problem, std::string& message) const {
  for (size_t k = 0; k < unknown_.size(); ++k) {
    if (unknown_[k] < 0) continue;
    const int frame = static_cast<int>(k);
    const auto shares = [&](const Observation& o) {
      const auto j = static_cast<size_t>(o.landmark);
      return o.key_frame == frame && first_[j + 1] - first_[j] > 1;
    };
    const auto moves = [&](const MotionPrior& m) { return m.from == frame || m.to == frame; };
    if (std::any_of(observations_.begin(), observations_.end(), shares)) continue;
    if (std::any_of(problem.motions.begin(), problem.motions.end(), moves)) continue;
    message = fmt::format("key frame {} shares no landmark with another", k);
    return false;
  }
  return true;
}

bool WindowAdjustment::minimise(const AdjustmentProblem& problem, AdjustmentResult& result) {
  double damping = kFirstDamping;
  double cost = linearise(problem, damping);
  result.cost_before = cost;
  for (; result.iterations < options_.max_iterations && damping < kMostDamping; ++result.iterations) {
    T_kept_ = T_odom_left_;
    p_kept_ = p_odom_;
    if (!step()) {
      result.message = "the observations do not determine the key frames";
      return false;
    }
    const double next_damping = std::max(0.1 * damping, kLeastDamping);
    const double next_cost = linearise(problem, next_damping);
    if (next_cost <= cost) {
      const bool converged = cost - next_cost <= kConverged * cost;
      cost = next_cost;
      damping = next_damping;
      if (converged) break;
    } else {
      T_odom_left_ = T_kept_;
      p_odom_ = p_kept_;
      damping *= 100;
      linearise(problem, damping);
    }
  }
  for (Pose& T : T_odom_left_) T = renormalised(T);
  result.cost_after = cost;
  return true;
}

double WindowAdjustment::linearise(const AdjustmentProblem& problem, double damping) {
  clear_equations();
  double cost = 0;
  for (size_t j = 0; j < p_odom_.size(); ++j) {
    cost += reduce(j, damping);
    add_landmark(j);
  }
  cost += add_priors(problem);
  H_.diagonal().head(unknowns_) += damping * diagonal_.head(unknowns_);
  return cost;
}

void WindowAdjustment::clear_equations() {
  H_.topLeftCorner(unknowns_, unknowns_).setZero();
  g_.setZero();
  diagonal_.setZero();
}

double WindowAdjustment::add_priors(const AdjustmentProblem& problem) {
  double cost = 0;
  for (const MotionPrior& motion : problem.motions) cost += add_motion(motion);
  for (size_t k = 0; k < unknown_.size(); ++k) cost += add_plane(problem.plane, k);
  return cost;
}

double WindowAdjustment::reduce(size_t landmark, double damping) {
  const double k2 = options_.lorentz_scale * options_.lorentz_scale;
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  double cost = 0;
  Eigen::Matrix3d H_ll = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g_l = Eigen::Vector3d::Zero();
  for (size_t n = begin; n < end; ++n) {
    const Observation& o = observations_[n];
    ObservationTerms& t = terms_[n - begin];
    observation_terms(rig_, T_odom_left_[static_cast<size_t>(o.key_frame)], p_odom_[landmark], o.uvu_px,
                      o.information, t);
    s_[n] = t.s;
    weight_[n] = 1 / (1 + t.s / k2);  // of k^2 log(1 + s / k^2), as its derivative by s
    cost += k2 * std::log1p(t.s / k2);
    H_ll += weight_[n] * t.H_ll;
    g_l += weight_[n] * t.g_l;
  }
  H_ll.diagonal() *= 1 + damping;
  own_step_[landmark].setZero();
  if (!determined_[landmark] || !invert(H_ll, inverse_ll_[landmark])) {
    determined_[landmark] = 0;  // from now on it stays where it is and has no say
    inverse_ll_[landmark].setZero();
    for (size_t n = begin; n < end; ++n) gain_[n].setZero();
    return 0;
  }
  own_step_[landmark] = inverse_ll_[landmark] * g_l;
  for (size_t n = begin; n < end; ++n)
    gain_[n].noalias() = weight_[n] * terms_[n - begin].H_xl * inverse_ll_[landmark];
  return cost;
}

void WindowAdjustment::add_landmark(size_t landmark) {
  if (!determined_[landmark]) return;
  const size_t begin = first_[landmark], end = first_[landmark + 1];
  for (size_t n = begin; n < end; ++n) {
    const int row = observations_[n].unknown;
    if (row < 0) continue;
    const ObservationTerms& t = terms_[n - begin];
    const Matrix63d H_xl = weight_[n] * t.H_xl;
    H_.block<6, 6>(row, row) += weight_[n] * t.H_xx;
    diagonal_.segment<6>(row) += weight_[n] * t.H_xx.diagonal();
    g_.segment<6>(row) += weight_[n] * t.g_x - H_xl * own_step_[landmark];
    for (size_t m = begin; m <= n; ++m) {
      const int column = observations_[m].unknown;
      if (column >= 0) H_.block<6, 6>(row, column).noalias() -= H_xl * gain_[m].transpose();
    }
  }
}

double WindowAdjustment::add_motion(const MotionPrior& motion) {
  const auto from = static_cast<size_t>(motion.from), to = static_cast<size_t>(motion.to);
  const RelativePoseError e = relative_pose_error(T_odom_left_[from], T_odom_left_[to], motion.T_from_to);
  const Matrix6d information = motion.covariance.llt().solve(Matrix6d::Identity());
  const int row[2] = {unknown_[from], unknown_[to]};
  const Matrix6d* const J[2] = {&e.J_from, &e.J_to};
  for (int a = 0; a < 2; ++a) {
    if (row[a] < 0) continue;
    const Matrix6d JtW = J[a]->transpose() * information;
    g_.segment<6>(row[a]) -= JtW * e.error;
    for (int b = 0; b < 2; ++b) {
      if (row[b] < 0 || row[b] > row[a]) continue;
      const Matrix6d H = JtW * *J[b];
      H_.block<6, 6>(row[a], row[b]) += H;
      if (a == b) diagonal_.segment<6>(row[a]) += H.diagonal();
    }
  }
  return e.error.dot(information * e.error);
}

double WindowAdjustment::add_plane(const GroundPlane& plane, size_t key_frame) {
  const int row = unknown_[key_frame];
  if (row < 0) return 0;
  const Pose& T_odom_left = T_odom_left_[key_frame];
  const Pose T_left_body = rig_.T_body_left.inverse();
  const Eigen::Vector3d normal_left = T_odom_left.linear().transpose() * plane.normal_odom;
  const auto add = [&](const Vector6d& J, double error, double sigma) {
    const double information = 1 / (sigma * sigma);
    const Matrix6d H = information * J * J.transpose();
    H_.block<6, 6>(row, row) += H;
    diagonal_.segment<6>(row) += H.diagonal();
    g_.segment<6>(row) -= information * error * J;
    return information * error * error;
  };
  double cost = 0;
  if (options_.planar_height_sigma_m > 0) {
    const Eigen::Vector3d p_left = T_left_body.translation();  // the body's origin
    Vector6d J;
    J << normal_left, p_left.cross(normal_left);
    cost +=
        add(J, plane.normal_odom.dot(T_odom_left * p_left) - plane.offset_m, options_.planar_height_sigma_m);
  }
  if (options_.planar_tilt_sigma_deg > 0) {
    // The normal seen from the body is (-pitch, roll, 1) for small angles: x and y of it should be zero.
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d axis_left = T_left_body.linear().col(axis);
      Vector6d J;
      J << Eigen::Vector3d::Zero(), axis_left.cross(normal_left);
      cost += add(J, axis_left.dot(normal_left), options_.planar_tilt_sigma_deg * std::numbers::pi / 180);
    }
  }
  return cost;
}

bool WindowAdjustment::step() {
  Eigen::Ref<Eigen::MatrixXd> H = H_.topLeftCorner(unknowns_, unknowns_);
  const LowerFactor llt(H);
  if (llt.info() != Eigen::Success) return false;
  Eigen::Ref<Eigen::VectorXd> x = g_.head(unknowns_);
  llt.solveInPlace(x);
  if (!x.allFinite()) return false;
  for (size_t k = 0; k < unknown_.size(); ++k) {
    if (unknown_[k] >= 0) T_odom_left_[k] = T_odom_left_[k] * se3_exp(x.segment<6>(unknown_[k]));
  }
  for (size_t j = 0; j < p_odom_.size(); ++j) {
    Eigen::Vector3d move = own_step_[j];
    for (size_t n = first_[j]; n < first_[j + 1]; ++n) {
      const int row = observations_[n].unknown;
      if (row >= 0) move.noalias() -= gain_[n].transpose() * x.segment<6>(row);
    }
    p_odom_[j] += move;
  }
  return true;
}

void WindowAdjustment::judge_observations(AdjustmentResult& result) {
  for (size_t n = 0; n < observations_.size(); ++n) {
    const bool agrees = s_[n] <= options_.outlier_sigmas * options_.outlier_sigmas;
    result.inlier[static_cast<size_t>(observations_[n].input)] = agrees ? 1 : 0;
    result.inliers += agrees ? 1 : 0;
  }
}

}  // namespace groundloop::slam
