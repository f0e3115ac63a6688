#include "sim/arm/arm_kinematics.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kSingular = 1e-6;  ///< sine of joint 5 below which joints 4 and 6 turn about the same axis

/// T_{i-1,i} of the standard convention.
slam::Pose link(double q_rad, double d_m, double a_m, double alpha_rad) {
  slam::Pose T = slam::Pose::Identity();
  T.rotate(Eigen::AngleAxisd(q_rad, Vector3d::UnitZ()));
  T.translate(Vector3d(a_m, 0, d_m));
  T.rotate(Eigen::AngleAxisd(alpha_rad, Vector3d::UnitX()));
  return T;
}

/// The angle a whole number of turns away from `angle_rad` that is nearest to `near_rad`.
double in_turn_near(double angle_rad, double near_rad) {
  return near_rad + std::remainder(angle_rad - near_rad, 2 * std::numbers::pi);
}

/// The turn nearest to `near_rad` that the limits allow; none when no turn is.
std::optional<double> within(double angle_rad, double near_rad, double low_rad, double high_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double nearest = in_turn_near(angle_rad, near_rad);
  for (const double turned :
       {nearest, nearest - kTurn, nearest + kTurn, nearest - 2 * kTurn, nearest + 2 * kTurn}) {
    if (turned >= low_rad && turned <= high_rad) return turned;
  }
  return std::nullopt;
}

/// Why there is no solution: of all postures the one that comes nearest.
class Shortfall {
 public:
  void note(double short_m, std::string why) {
    if (short_m < least_m_) least_m_ = short_m, reason_ = std::move(why);
  }
  const std::string& reason() const { return reason_; }

 private:
  double least_m_ = std::numeric_limits<double>::infinity();
  std::string reason_;
};

/// Angles of joint 1 that let the wrist reach the flange: the wrist is d4 beside the plane of upper arm and
/// forearm.
std::vector<double> shoulder_angles(const ArmGeometry& arm, const slam::Pose& T_base_flange,
                                    Shortfall& shortfall) {
  const Vector3d p_base_5 = T_base_flange * Vector3d(0, 0, -arm.d6_m);
  const double across_m = std::hypot(p_base_5.x(), p_base_5.y());
  if (across_m <= arm.d4_m) {
    const double short_m = arm.d4_m - across_m;
    shortfall.note(short_m, fmt::format("{:.1f} mm too near to the axis of the base", 1e3 * short_m));
    return {};
  }
  const double direction = std::atan2(p_base_5.y(), p_base_5.x()) + kQuarterTurn;
  const double spread = std::acos(arm.d4_m / across_m);
  return {direction + spread, direction - spread};
}

/// Angle of joint 6, when the axes of joints 4 and 6 are not parallel.
double hand_angle(const Eigen::Matrix3d& R_base_flange, double q1, double sin_q5) {
  const double s1 = std::sin(q1), c1 = std::cos(q1);
  return std::atan2((-R_base_flange(0, 1) * s1 + R_base_flange(1, 1) * c1) / sin_q5,
                    (R_base_flange(0, 0) * s1 - R_base_flange(1, 0) * c1) / sin_q5);
}

/// Joints 2 to 4 as a planar arm with two links and a hand, in the frame after joint 1.
class PlanarArm {
 public:
  PlanarArm(const ArmGeometry& arm, double least_elbow_rad, const slam::Pose& T_1_4)
      : arm_(arm),
        least_elbow_rad_(least_elbow_rad),
        turn_rad_(std::atan2(T_1_4.linear()(1, 0), T_1_4.linear()(0, 0))) {
    // the origin of frame 4 is d4 along its joint's axis from the end of the forearm
    wrist_ = T_1_4.translation().head<2>();
  }

  /// Both bends of the elbow; none out of reach.
  std::vector<double> elbow_angles(Shortfall& shortfall) const {
    const double a2 = arm_.a2_m, a3 = arm_.a3_m, distance_m = wrist_.norm();
    const auto at_elbow = [&](double q3) {
      return std::sqrt(a2 * a2 + a3 * a3 + 2 * a2 * a3 * std::cos(q3));
    };
    const double farthest_m = at_elbow(least_elbow_rad_),
                 nearest_m = at_elbow(std::numbers::pi - least_elbow_rad_);
    if (distance_m > farthest_m) {
      const double short_m = distance_m - farthest_m;
      shortfall.note(short_m, fmt::format("{:.1f} mm beyond the arm's reach", 1e3 * short_m));
      return {};
    }
    if (distance_m < nearest_m) {
      const double short_m = nearest_m - distance_m;
      shortfall.note(short_m, fmt::format("{:.1f} mm nearer than the arm can fold", 1e3 * short_m));
      return {};
    }
    const double q3 = std::acos((distance_m * distance_m - a2 * a2 - a3 * a3) / (2 * a2 * a3));
    return {q3, -q3};
  }
  double shoulder_lift(double q3) const {
    return std::atan2(wrist_.y(), wrist_.x()) -
           std::atan2(arm_.a3_m * std::sin(q3), arm_.a2_m + arm_.a3_m * std::cos(q3));
  }
  double turn_rad() const { return turn_rad_; }  ///< q2 + q3 + q4

 private:
  const ArmGeometry& arm_;
  double least_elbow_rad_;
  double turn_rad_;
  Eigen::Vector2d wrist_;
};

}  // namespace

slam::Pose forward_kinematics(const ArmGeometry& arm, const JointAngles& q) {
  return link(q[0], arm.d1_m, 0, kQuarterTurn) * link(q[1], 0, arm.a2_m, 0) * link(q[2], 0, arm.a3_m, 0) *
         link(q[3], arm.d4_m, 0, kQuarterTurn) * link(q[4], arm.d5_m, 0, -kQuarterTurn) *
         link(q[5], arm.d6_m, 0, 0);
}

InverseKinematics inverse_kinematics(const ArmGeometry& arm, const JointLimits& limits,
                                     const slam::Pose& T_base_flange, const JointAngles& near) {
  InverseKinematics answer;
  Shortfall shortfall;
  const auto add = [&](const JointAngles& q) {
    JointAngles allowed;
    for (int joint = 0; joint < 6; ++joint) {
      const auto angle = within(q[joint], near[joint], limits.low[joint], limits.high[joint]);
      if (!angle) {
        shortfall.note(0, fmt::format("joint {} would have to turn to {:.1f} deg, beyond its limits",
                                      joint + 1, in_turn_near(q[joint], 0) * 180 / std::numbers::pi));
        return;
      }
      allowed[joint] = *angle;
    }
    answer.solutions.push_back(allowed);
  };

  const Eigen::Matrix3d R = T_base_flange.linear();
  const Vector3d p = T_base_flange.translation();
  for (const double q1 : shoulder_angles(arm, T_base_flange, shortfall)) {
    const double beside_m = p.x() * std::sin(q1) - p.y() * std::cos(q1);
    const double cos_q5 = std::clamp((beside_m - arm.d4_m) / arm.d6_m, -1.0, 1.0);
    for (const double q5 : {std::acos(cos_q5), -std::acos(cos_q5)}) {
      const double sin_q5 = std::sin(q5);
      const double q6 = std::abs(sin_q5) < kSingular ? near[5] : hand_angle(R, q1, sin_q5);
      const slam::Pose T_4_flange = link(q5, arm.d5_m, 0, -kQuarterTurn) * link(q6, arm.d6_m, 0, 0);
      const slam::Pose T_1_4 =
          link(q1, arm.d1_m, 0, kQuarterTurn).inverse() * T_base_flange * T_4_flange.inverse();
      const PlanarArm planar(arm, limits.least_elbow_rad, T_1_4);
      for (const double q3 : planar.elbow_angles(shortfall)) {
        const double q2 = planar.shoulder_lift(q3);
        JointAngles q;
        q << q1, q2, q3, planar.turn_rad() - q2 - q3, q5, q6;
        add(q);
      }
    }
  }
  if (answer.solutions.empty()) answer.reason = shortfall.reason();
  return answer;
}

}  // namespace groundloop::sim
