#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "slam/types/pose.h"

namespace groundloop::sim {

/// Angles of the six joints, from the base to the hand [rad].
using JointAngles = Eigen::Matrix<double, 6, 1>;

/// Lengths of an arm of the UR family, as in its maker's Denavit-Hartenberg table (standard convention:
/// T_{i-1,i} = Rz(q_i) Tz(d_i) Tx(a_i) Rx(alpha_i), alpha = 90, 0, 0, 90, -90, 0 degrees) [m].
struct ArmGeometry {
  double d1_m = 0;
  double a2_m = 0;  ///< negative, as the maker has it
  double a3_m = 0;  ///< likewise
  double d4_m = 0;
  double d5_m = 0;
  double d6_m = 0;

  /// Distance of the wrist from the shoulder with the elbow stretched.
  double reach_m() const { return -(a2_m + a3_m); }
};

/// The elbow is kept so far from stretched and from folded: beyond it, joints would have to run without bound
/// to move the hand evenly, and the least error of a pose could leave it without a solution.
inline constexpr double kLeastElbow_rad = 0.09;

/// Limits of the six joints [rad].
struct JointLimits {
  JointAngles low = JointAngles::Constant(-1e9);
  JointAngles high = JointAngles::Constant(1e9);
  double least_elbow_rad = kLeastElbow_rad;  ///< from stretched, and from folded
};

/// Pose of the flange in the base.
slam::Pose forward_kinematics(const ArmGeometry& arm, const JointAngles& q);

/// Joint angles that bring the flange to a pose.
struct InverseKinematics {
  std::vector<JointAngles>
      solutions;       ///< up to eight: shoulder left or right, wrist up or down, elbow likewise
  std::string reason;  ///< why there are none: what the posture lacks that comes nearest
};

/// All solutions within the limits, in a fixed order, each angle in the turn that is nearest to `near`
/// (Hawkins, "Analytic inverse kinematics for the Universal Robots UR-5/UR-10 arms", 2013, with the elbow's
/// triangle solved as for a planar arm of two links). Where the axes of joints 4 and 6 are parallel only
/// their sum is determined: joint 6 then stays where it is in `near`.
InverseKinematics inverse_kinematics(const ArmGeometry& arm, const JointLimits& limits,
                                     const slam::Pose& T_base_flange, const JointAngles& near);

}  // namespace groundloop::sim
