#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "slam/adjustment/adjustment_problem.h"
#include "slam/adjustment/observation_terms.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Bundle adjustment of the newest key frames and of what they saw, robust against false matches.
///
/// Minimises  sum k^2 log(1 + s_n / k^2)  over all free poses and all landmarks, with s_n the squared misfit
/// of observation n in standard deviations of (u_left, v, u_right) and k the Lorentzian's scale, plus the
/// squared misfits of the priors: Levenberg-Marquardt on reweighted normal equations. The landmarks are
/// eliminated one by one (Schur complement; Triggs et al., "Bundle adjustment - a modern synthesis", 2000),
/// which leaves six unknowns a free key frame.
///
/// The window is ANCHORED, not marginalised: key frames marked fixed are taken as exact, and what older ones
/// knew of the landmarks is forgotten. With one anchor, the oldest, nothing is taken as exact but the frame
/// of reference, and the covariances of the motions are honest; the price is what forgotten observations
/// would still say. More anchors hold on to older landmarks, but covariances are then those given the
/// anchors, whose own errors they do not know (docs/decisions/0013-an-anchored-window.md).
///
/// Single-threaded and deterministic. Storage is kept: no allocation once problems of that size were solved.
class WindowAdjustment {
 public:
  WindowAdjustment(const StereoRig& rig, const AdjustmentOptions& options) : rig_(rig), options_(options) {}

  /// @param result  overwritten; its storage is reused
  void solve(const AdjustmentProblem& problem, AdjustmentResult& result);

 private:
  /// An observation as the solver keeps it: by landmark, then key frame.
  struct Observation {
    Eigen::Vector3d uvu_px;
    Eigen::Matrix3d information;  ///< inverse covariance of uvu_px
    int landmark;
    int key_frame;
    int unknown;  ///< first of the six unknowns of its key frame, -1 for an anchor
    int input;    ///< index in the problem
  };

  bool prepare(const AdjustmentProblem& problem, std::string& message);
  bool sort_observations(const AdjustmentProblem& problem, std::string& message);
  bool connected(const AdjustmentProblem& problem, std::string& message) const;
  bool minimise(const AdjustmentProblem& problem, AdjustmentResult& result);
  /// Reduced normal equations H_, g_ at the current estimate, their diagonal enlarged by 1 + damping.
  /// @return the cost there
  double linearise(const AdjustmentProblem& problem, double damping);
  void clear_equations();
  /// Linearises what was seen of a landmark into terms_ and solves for its own position, H_ll enlarged by
  /// 1 + damping. @return its cost; 0 when it is not determined
  double reduce(size_t landmark, double damping);
  /// Adds what the reduced landmark tells of the poses.
  void add_landmark(size_t landmark);
  double add_priors(const AdjustmentProblem& problem);
  double add_motion(const MotionPrior& motion);
  double add_plane(const GroundPlane& plane, size_t key_frame);
  /// Moves poses and landmarks by the solution of H_, g_. @return false when there is none
  bool step();
  bool uncertainty(const AdjustmentProblem& problem, AdjustmentResult& result);
  void add_slope(size_t landmark);
  void add_noise(size_t landmark);
  void unbend(size_t landmark);
  bool pairs_err() const { return options_.pair_sigma_m > 0 || options_.pair_sigma_deg > 0; }
  void add_sway(size_t landmark);
  void add_noise_of_pairs(double slope_size);
  Eigen::Matrix3d landmark_covariance(size_t landmark) const;
  double small_sample_factor(int key_frame) const;
  void motion_covariances(AdjustmentResult& result) const;
  void judge_observations(AdjustmentResult& result);

  StereoRig rig_;
  AdjustmentOptions options_;

  std::vector<Observation> observations_;
  std::vector<size_t> first_;  ///< per landmark: its first observation; one more at the end
  std::vector<int> unknown_;   ///< per key frame: first of its six unknowns, -1 for an anchor
  Eigen::Index unknowns_ = 0;

  std::vector<Pose> T_odom_left_, T_kept_;        ///< per key frame: estimate, and the last accepted
  std::vector<Eigen::Vector3d> p_odom_, p_kept_;  ///< per landmark
  std::vector<ObservationTerms> terms_;           ///< of the observations of one landmark
  std::vector<Vector6d> pull_, own_pull_,
      moved_;                                ///< of the same: gradients, and how far they move the poses
  std::vector<double> weight_, s_;           ///< per observation: robust weight, squared misfit
  std::vector<Matrix63d> gain_;              ///< per observation: H_xl H_ll^-1
  std::vector<uint8_t> determined_;          ///< per landmark: by its observations
  std::vector<Eigen::Matrix3d> inverse_ll_;  ///< per landmark: H_ll^-1, zero when not determined
  std::vector<Eigen::Vector3d> own_step_;    ///< per landmark: H_ll^-1 g_l

  // The leading unknowns_ x unknowns_ part, of H_ and noise_ the lower triangle; kept at the largest size so
  // far.
  Eigen::MatrixXd H_;           ///< reduced information, then its Cholesky factor
  Eigen::MatrixXd noise_;       ///< covariance of the reduced gradient
  Eigen::MatrixXd covariance_;  ///< of all free poses; before that, the inverse of H_
  Eigen::VectorXd g_, diagonal_, slope_;
  Eigen::MatrixXd sway_;  ///< of the reduced gradient by the twists of the right cameras, six a key frame
};

}  // namespace groundloop::slam
