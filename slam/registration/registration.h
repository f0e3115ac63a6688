#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "slam/types/config.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {

/// How the misfit of a pair of points is weighed.
enum class RegistrationCost {
  kScalarQuadratic,  ///< paper, sigma_i ~ Z^2: the error of a stereo depth grows with the square of distance
  kScalarLinear,     ///< paper, read literally: the variance grows with the square, sigma_i ~ Z
  kReprojection      ///< misfit in the image, with the whole covariance of both measurements
};

/// Options of registration. YAML: slam.registration
struct RegistrationOptions {
  RegistrationCost cost = RegistrationCost::kReprojection;
  double sigma_px = 0.12;       ///< standard deviation of one image coordinate of a typical tracked feature
  double lorentz_scale = 1.0;   ///< in standard deviations: larger misfits lose weight
  double inlier_gate_px = 2.5;  ///< reprojection misfit that still counts as agreement
  int ransac_iterations = 100;  ///< three-point samples tried for the start
  int max_iterations = 30;
  int min_inliers = 12;            ///< fewer: lost
  double min_inlier_ratio = 0.25;  ///< of the tracked points; fewer: lost

  template <class Archive>
  void visit(Archive& a) {
    a("cost", cost);
    a("sigma_px", sigma_px, {.min = 0.01, .max = 10});
    a("lorentz_scale", lorentz_scale, {.min = 0.1, .max = 100});
    a("inlier_gate_px", inlier_gate_px, {.min = 0.1, .max = 50});
    a("ransac_iterations", ransac_iterations, {.min = 0, .max = 10000});
    a("max_iterations", max_iterations, {.min = 1, .max = 1000});
    a("min_inliers", min_inliers, {.min = 4, .max = 1000});
    a("min_inlier_ratio", min_inlier_ratio, {.min = 0, .max = 1});
  }
};

/// One feature reconstructed at two times.
struct PointPair {
  Eigen::Vector3d p_from;           ///< 3D point from the first reconstruction, in that left camera [m]
  Eigen::Matrix3d covariance_from;  ///< of p_from [m^2]
  Eigen::Vector3d uvu_to;           ///< (u_left, v, u_right) in the second pair [px]
  Eigen::Matrix3d cofactor_to = equal_cofactor();  ///< covariance of uvu_to relative to sigma_px^2
};

/// What came out, and why.
struct RegistrationResult {
  bool usable = false;
  std::string message = "not run";
  Pose T_from_to = Pose::Identity();  ///< pose of the second left camera in the first
  /// Of T_from_to, right perturbation (translation, rotation) in `to`: of the errors that this cost makes
  /// from measurements of the stated precision.
  Matrix6d covariance = Matrix6d::Zero();
  std::vector<uint8_t> inlier;  ///< per pair
  int inliers = 0;
  double residual_px = 0;  ///< rms reprojection misfit of the inliers, per coordinate
  int iterations = 0;
};

/// Rigid motion between two reconstructions of the same features, robust against false matches.
///
/// Minimises J = sum log(1 + |d_i|^2 / sigma_i^2) (section 2.3 of the paper) by iteratively reweighted least
/// squares, starting from the better of the prediction and the best three-point sample. With kReprojection,
/// d_i is the misfit in the image and |d_i|^2 / sigma_i^2 becomes d^T S^-1 d with S the covariance of d.
class Registration {
 public:
  Registration(const StereoRig& rig, const RegistrationOptions& options) : rig_(rig), options_(options) {}

  /// @param predicted_T_from_to  from the plan
  /// @param seed                 of the samples; the same seed gives the same result
  /// @param result               overwritten; its storage is reused
  void align(const std::vector<PointPair>& pairs, const Pose& predicted_T_from_to, uint64_t seed,
             RegistrationResult& result);

 private:
  /// Best of the prediction and the sampled motions, by the number of pairs within the gate.
  Pose robust_start(const std::vector<PointPair>& pairs, const Pose& predicted_T_to_from, uint64_t seed);
  int refine_scalar(const std::vector<PointPair>& pairs, Pose& T_to_from);
  int refine_reprojection(const std::vector<PointPair>& pairs, Pose& T_to_from);
  Matrix6d information(const std::vector<PointPair>& pairs, const Pose& T_to_from, Vector6d* gradient) const;
  bool covariance(const std::vector<PointPair>& pairs, const Pose& T_to_from, Matrix6d& covariance) const;
  double misfit2_px(const PointPair& pair, const Pose& T_to_from) const;

  StereoRig rig_;
  RegistrationOptions options_;
  std::vector<Eigen::Vector3d> sample_from_{3}, sample_to_{3};  ///< of three pairs
  std::vector<double> equal_weights_{1, 1, 1};
  std::vector<Eigen::Vector3d> p_from_, p_to_;
  std::vector<double> variance_, weight_;
};

/// Weighted rigid motion that takes a to b: minimises sum w_i |b_i - (R a_i + t)|^2 (Horn / Kabsch, by SVD).
/// Needs three points that are not on a line.
Pose weighted_rigid(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b,
                    const std::vector<double>& weight);

}  // namespace groundloop::slam

namespace groundloop {
template <>
struct EnumNames<slam::RegistrationCost> {
  static constexpr std::array<std::pair<slam::RegistrationCost, const char*>, 3> names = {
      {{slam::RegistrationCost::kScalarQuadratic, "scalar_quadratic"},
       {slam::RegistrationCost::kScalarLinear, "scalar_linear"},
       {slam::RegistrationCost::kReprojection, "reprojection"}}};
};
}  // namespace groundloop
