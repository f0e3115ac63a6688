#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "slam/types/pose.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {

/// Options of the windowed bundle adjustment. YAML: slam.adjustment
struct AdjustmentOptions {
  int key_frames = 8;           ///< newest key frames in the window, the anchored ones included; 0: off
  int max_iterations = 5;       ///< of reweighted least squares
  double sigma_px = 0.12;       ///< standard deviation of one image coordinate of a typical tracked feature
  double lorentz_scale = 1.0;   ///< in standard deviations: larger misfits lose weight
  double outlier_sigmas = 5.0;  ///< misfit in standard deviations from which an observation counts as false
  /// Variance of the motions, relative to that of landmarks which err independently of each other: windows on
  /// one surface err alike. Measured: key-frame motions of drives through several rooms have a mean NEES
  /// of 6.
  double error_likeness = 1.15;
  double planar_height_sigma_m = 0;  ///< soft planar motion: height of the body over the plane; 0: off
  double planar_tilt_sigma_deg = 0;  ///< soft planar motion: roll and pitch of the body; 0: off
  /// Deviation of the right camera from its place beside the left one, anew in every pair, as an arm has that
  /// stops twice for a pair: the covariances know of it. 0: one head. Place in each coordinate; turn about
  /// each axis.
  double pair_sigma_m = 0;
  double pair_sigma_deg = 0;
  double plan_sigma_ratio = 0;  ///< deviation of a planned motion relative to its length and angle; 0: off

  template <class Archive>
  void visit(Archive& a) {
    a("key_frames", key_frames, {.min = 0, .max = 64});
    a("max_iterations", max_iterations, {.min = 1, .max = 1000});
    a("sigma_px", sigma_px, {.min = 0.01, .max = 10});
    a("lorentz_scale", lorentz_scale, {.min = 0.1, .max = 100});
    a("outlier_sigmas", outlier_sigmas, {.min = 0.1, .max = 1000});
    a("error_likeness", error_likeness, {.min = 0.1, .max = 100});
    a("planar_height_sigma_m", planar_height_sigma_m, {.min = 0, .max = 10});
    a("planar_tilt_sigma_deg", planar_tilt_sigma_deg, {.min = 0, .max = 90});
    a("pair_sigma_m", pair_sigma_m, {.min = 0, .max = 1});
    a("pair_sigma_deg", pair_sigma_deg, {.min = 0, .max = 10});
    a("plan_sigma_ratio", plan_sigma_ratio, {.min = 0, .max = 10});
  }
};

struct AdjustmentKeyFrame {
  Pose T_odom_left = Pose::Identity();
  bool fixed = false;  ///< an anchor: its pose is taken as exact
};

/// One landmark seen in one key frame, in both images.
struct AdjustmentObservation {
  int key_frame = 0;                                 ///< index into key_frames
  int landmark = 0;                                  ///< index into landmarks_odom
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< (u_left, v, u_right)
  double sigma_px = 0;                               ///< of one coordinate of one image
  Eigen::Matrix3d cofactor = equal_cofactor();       ///< covariance of uvu_px relative to sigma_px^2
};

/// A relative motion known from elsewhere: plan or wheel odometry.
struct MotionPrior {
  int from = 0, to = 0;  ///< indices into key_frames
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of T_from_to, right perturbation in `to`
};

/// Plane that the body drives on, as far as planar motion is a prior: normal . p = offset.
struct GroundPlane {
  Eigen::Vector3d normal_odom = Eigen::Vector3d::UnitZ();  ///< unit length
  double offset_m = 0;
};

/// What one adjustment is about. Key frames in order of time; observations in any order, at most one of a
/// landmark in a key frame. `odom` is any frame in which all of it is given.
struct AdjustmentProblem {
  std::vector<AdjustmentKeyFrame> key_frames;
  std::vector<Eigen::Vector3d> landmarks_odom;  ///< [m]
  std::vector<AdjustmentObservation> observations;
  std::vector<MotionPrior> motions;
  GroundPlane plane;
};

/// What came out, and why. Poses and landmarks are those of the problem unless `usable`.
struct AdjustmentResult {
  bool usable = false;
  std::string message = "not run";
  std::vector<Pose> T_odom_left;                ///< per key frame
  std::vector<Eigen::Vector3d> landmarks_odom;  ///< per landmark [m]
  std::vector<uint8_t> inlier;                  ///< per observation, in the problem's order
  int inliers = 0;
  /// Per landmark [m^2], in odom: of its position when the poses are given (conditional, not marginal). Zero
  /// for a landmark that its observations do not determine.
  std::vector<Eigen::Matrix3d> landmark_covariance;
  /// Per key frame k >= 1: covariance of T_(k-1)_(k) by the misfits, their likeness and what is told of the
  /// pairs, landmarks and other poses integrated out; right perturbation in key frame k. Entry 0, and pairs
  /// of two anchors, are zero.
  std::vector<Matrix6d> motion_covariance;
  double cost_before = 0, cost_after = 0;  ///< sum k^2 log(1 + s / k^2) over observations, plus the priors
  int iterations = 0;
};

/// Covariance of a planned or odometric motion: standard deviations of 1 mm + ratio x length and of
/// 0.05 deg + ratio x angle, the same in all directions.
Matrix6d planned_motion_covariance(const Pose& T_from_to, double plan_sigma_ratio);

}  // namespace groundloop::slam
