#include "bench/metrics/point_truth.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <cmath>

#include "bench/metrics/alignment.h"
#include "bench/metrics/trajectory_file.h"

namespace groundloop::bench {
namespace {

constexpr double kSoftL1_m = 0.05;
constexpr double kHeightWeight = 0.2;
constexpr double kLeverWeight = 0.02;
constexpr int kParameters = 9;  ///< rotation vector, translation, lever arm

/// One component (0: x, 1: y, 2: weighted height) of one point's residual. Components are separate residuals
/// since the loss is taken of each alone.
struct PointResidual {
  slam::Pose T_map_left;
  Eigen::Vector2d p_world;
  int component;

  template <class T>
  bool operator()(const T* x, T* residual) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> lever(x + 6);
    const Eigen::Matrix<T, 3, 1> p_map =
        T_map_left.linear().cast<T>() * lever + T_map_left.translation().cast<T>();
    T rotated[3];
    ceres::AngleAxisRotatePoint(x, p_map.data(), rotated);
    const T value = rotated[component] + x[3 + component];
    *residual = component == 2 ? kHeightWeight * value : value - p_world[component];
    return true;
  }
};

struct LeverResidual {
  int component;

  template <class T>
  bool operator()(const T* x, T* residual) const {
    *residual = kLeverWeight * x[6 + component];
    return true;
  }
};

template <class Residual>
void add(ceres::Problem& problem, ceres::LossFunction* loss, double* x, Residual residual) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<Residual, 1, kParameters>(new Residual(std::move(residual))), loss, x);
}

Eigen::Vector2d interpolated(const PointTruth& truth, int64_t stamp_ns) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), stamp_ns,
                                      [](const PlanarPoint& p, int64_t t) { return p.stamp_ns < t; });
  if (after == truth.begin()) return truth.front().p_world;
  if (after == truth.end()) return truth.back().p_world;
  const auto before = after - 1;
  const double part = static_cast<double>(stamp_ns - before->stamp_ns) /
                      static_cast<double>(after->stamp_ns - before->stamp_ns);
  return before->p_world + part * (after->p_world - before->p_world);
}

}  // namespace

PointTruth read_point_truth(const std::string& file) {
  PointTruth truth;
  for (const slam::StampedPose& pose : read_trajectory(file, TrajectoryFormat::kTum).poses) {
    truth.push_back({pose.stamp_ns, pose.T.translation().head<2>()});
  }
  return truth;
}

std::optional<PlanarFit> fit_planar(const PointTruth& truth, const slam::Trajectory& T_map_left) {
  if (truth.empty() || T_map_left.size() < 3) return std::nullopt;
  Eigen::Matrix3Xd p_world = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(T_map_left.size()));
  for (size_t i = 0; i < T_map_left.size(); ++i) {
    p_world.col(static_cast<Eigen::Index>(i)).head<2>() = interpolated(truth, T_map_left[i].stamp_ns);
  }

  // start: the camera itself is the point
  const slam::Pose T_start = align_points(p_world, positions_of(T_map_left), false).T_truth_map;
  Eigen::Matrix<double, kParameters, 1> x;
  x << slam::so3_log(T_start.linear()), T_start.translation(), Eigen::Vector3d::Zero();

  ceres::SoftLOneLoss loss(kSoftL1_m);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (size_t i = 0; i < T_map_left.size(); ++i) {
    for (int component = 0; component < 3; ++component) {
      const Eigen::Vector2d p = p_world.col(static_cast<Eigen::Index>(i)).head<2>();
      add(problem, &loss, x.data(), PointResidual{T_map_left[i].T, p, component});
    }
  }
  for (int component = 0; component < 3; ++component) add(problem, &loss, x.data(), LeverResidual{component});

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  PlanarFit fit;
  fit.T_world_map.linear() = slam::so3_exp(Eigen::Vector3d(x.head<3>()));
  fit.T_world_map.translation() = x.segment<3>(3);
  fit.p_left_point = x.tail<3>();
  double sum = 0, sum_height = 0;
  for (size_t i = 0; i < T_map_left.size(); ++i) {
    const Eigen::Vector3d q = fit.T_world_map * (T_map_left[i].T * fit.p_left_point);
    const double error_m = (q - p_world.col(static_cast<Eigen::Index>(i))).head<2>().norm();
    sum += error_m * error_m;
    sum_height += q.z() * q.z();
    fit.max_m = std::max(fit.max_m, error_m);
  }
  const auto n = static_cast<double>(T_map_left.size());
  fit.rmse_m = std::sqrt(sum / n);
  fit.height_rms_m = std::sqrt(sum_height / n);
  return fit;
}

Metrics planar_metrics(const PlanarFit& fit) {
  return {{"trajectory.planar_rmse_m", fit.rmse_m}, {"trajectory.planar_max_m", fit.max_m}};
}

}  // namespace groundloop::bench
