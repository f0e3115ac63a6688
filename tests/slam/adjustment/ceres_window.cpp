#include "tests/slam/adjustment/ceres_window.h"

#include <ceres/ceres.h>

#include <numbers>

#include "slam/adjustment/relative_pose.h"

namespace groundloop::slam {
namespace {

using RowMajor37 = Eigen::Matrix<double, 3, 7, Eigen::RowMajor>;
using RowMajor33 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using Stored = std::array<double, 7>;  // translation, quaternion (x, y, z, w)

Pose pose_of(const double* x) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(x + 3).toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(x);
  return T;
}

void store(const Pose& T, double* x) {
  Eigen::Map<Eigen::Vector3d>{x} = T.translation();
  Eigen::Map<Eigen::Quaterniond> q(x + 3);
  q = Eigen::Quaterniond(T.linear());
  q.normalize();
}

/// T exp(twist). Cost functions give derivatives by the twist in the first six of seven columns.
class RightTwist : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* out) const override {
    store(pose_of(x) * se3_exp(Eigen::Map<const Vector6d>(delta)), out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    Eigen::Map<Vector6d>{delta} = se3_log(pose_of(x).inverse() * pose_of(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

class StereoCost : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  StereoCost(const StereoRig& rig, const AdjustmentObservation& o) : rig_(rig), o_(o) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Pose T = pose_of(x[0]);
    const Eigen::Vector3d p = T.inverse() * Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(x[1]));
    const Eigen::Vector3d scale = Eigen::Vector3d(1, std::numbers::sqrt2, 1) / o_.sigma_px;
    Eigen::Map<Eigen::Vector3d>(residuals).array() = scale.array() * (rig_.project(p) - o_.uvu_px).array();
    if (jacobians == nullptr) return true;
    const double iz = 1 / p.z(), f = rig_.fx_px * iz, g = rig_.fy_px * iz;
    Eigen::Matrix3d G;
    G << f, 0, -f * p.x() * iz, 0, g, -g * p.y() * iz, f, 0, -f * (p.x() - rig_.baseline_m) * iz;
    G = (scale.asDiagonal() * G).eval();
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor37> J(jacobians[0]);
      J << -G, G * skew(p), Eigen::Vector3d::Zero();
    }
    if (jacobians[1] != nullptr) Eigen::Map<RowMajor33>{jacobians[1]} = G * T.linear().transpose();
    return true;
  }

 private:
  const StereoRig& rig_;
  const AdjustmentObservation& o_;
};

class MotionCost : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  explicit MotionCost(const MotionPrior& m) : m_(m) {
    root_ = Matrix6d(m.covariance.inverse()).llt().matrixU();
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const RelativePoseError e = relative_pose_error(pose_of(x[0]), pose_of(x[1]), m_.T_from_to);
    Eigen::Map<Vector6d>{residuals} = root_ * e.error;
    if (jacobians == nullptr) return true;
    const Matrix6d J[2] = {root_ * e.J_from, root_ * e.J_to};
    for (int i = 0; i < 2; ++i) {
      if (jacobians[i] != nullptr) Eigen::Map<RowMajor67>(jacobians[i]) << J[i], Vector6d::Zero();
    }
    return true;
  }

 private:
  const MotionPrior& m_;
  Matrix6d root_;
};

}  // namespace

AdjustmentResult ceres_window(const StereoRig& rig, const AdjustmentOptions& options,
                              const AdjustmentProblem& problem, double tolerance) {
  std::vector<Stored> poses(problem.key_frames.size());
  std::vector<Eigen::Vector3d> landmarks = problem.landmarks_odom;
  ceres::Problem ceres_problem;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (size_t k = 0; k < poses.size(); ++k) {
    store(problem.key_frames[k].T_odom_left, poses[k].data());
    ceres_problem.AddParameterBlock(poses[k].data(), 7, new RightTwist);
    if (problem.key_frames[k].fixed) ceres_problem.SetParameterBlockConstant(poses[k].data());
    ordering->AddElementToGroup(poses[k].data(), 1);
  }
  for (const AdjustmentObservation& o : problem.observations) {
    double* landmark = landmarks[static_cast<size_t>(o.landmark)].data();
    ceres_problem.AddResidualBlock(new StereoCost(rig, o), new ceres::CauchyLoss(options.lorentz_scale),
                                   poses[static_cast<size_t>(o.key_frame)].data(), landmark);
    ordering->AddElementToGroup(landmark, 0);
  }
  for (const MotionPrior& m : problem.motions) {
    ceres_problem.AddResidualBlock(new MotionCost(m), nullptr, poses[static_cast<size_t>(m.from)].data(),
                                   poses[static_cast<size_t>(m.to)].data());
  }
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_SCHUR;
  settings.linear_solver_ordering.reset(ordering);
  settings.num_threads = 1;
  settings.max_num_iterations = options.max_iterations;
  settings.function_tolerance = settings.gradient_tolerance = settings.parameter_tolerance = tolerance;
  settings.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &ceres_problem, &summary);

  AdjustmentResult result;
  result.usable = summary.IsSolutionUsable();
  result.message = summary.message;
  for (const Stored& pose : poses) result.T_odom_left.push_back(pose_of(pose.data()));
  result.landmarks_odom = landmarks;
  result.cost_before = 2 * summary.initial_cost;  // Ceres halves it
  result.cost_after = 2 * summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  return result;
}

}  // namespace groundloop::slam
