#include "sim/arm/arm_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "sim/arm/arm_clearance.h"
#include "sim/arm/arm_servo.h"

namespace groundloop::sim {
namespace {

/// A posture at a stop, for its two images.
using Posture = std::array<JointAngles, 2>;

/// How far the joints turn from one to another, whole turns left out.
double effort(const JointAngles& from, const JointAngles& to) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) {
    const double turn_rad = std::remainder(to[i] - from[i], 2 * std::numbers::pi);
    sum += turn_rad * turn_rad;
  }
  return sum;
}

const JointAngles& nearest(const std::vector<JointAngles>& solutions, const JointAngles& q) {
  return *std::min_element(
      solutions.begin(), solutions.end(),
      [&](const JointAngles& a, const JointAngles& b) { return effort(q, a) < effort(q, b); });
}

std::string place_of(const CameraStop& stop) {
  const Eigen::Vector3d p = stop.T_world_left.translation();
  return fmt::format("x {:.3f} m, y {:.3f} m, z {:.3f} m", p.x(), p.y(), p.z());
}

class Planner {
 public:
  Planner(const Scenario& scenario, const World& world, const ArmModel& arm, double baseline_m,
          int64_t period_ns)
      : scenario_(scenario),
        arm_(arm),
        clearance_(world, arm),
        margin_m_(kArmClearance_m * scenario.scale),
        baseline_m_(baseline_m),
        period_s_(static_cast<double>(period_ns) * 1e-9) {
    plan_.stops = camera_stops(scenario, period_ns);
  }

  ArmPlan make() {
    for (const CameraStop& stop : plan_.stops) {
      postures_.push_back(postures_at(stop));
      go_to_next_stop();
    }
    give_up_on_problems();
    choose();
    for (size_t i = 0; i < plan_.stops.size(); ++i) {
      check_way_to(i);
      go_to_next_stop();
    }
    give_up_on_problems();
    return std::move(plan_);
  }

 private:
  void give_up_on_problems() {
    if (problems_.empty()) return;
    throw InputError(std::move(problems_));
  }

  InverseKinematics solve(const CameraStop& stop, Side side, const JointAngles& near) const {
    const slam::Pose T_world_flange =
        ArmPlan::T_world_camera(stop, side, baseline_m_) * arm_.T_flange_camera.inverse();
    return inverse_kinematics(arm_.geometry, arm_.limits, arm_.T_world_base.inverse() * T_world_flange, near);
  }

  /// All postures that reach both images and touch nothing there.
  std::vector<Posture> postures_at(const CameraStop& stop) {
    const JointAngles near = JointAngles::Zero();
    std::string reason, touched;
    std::vector<Posture> postures;
    const InverseKinematics left = solve(stop, kLeft, near);
    reason = left.reason;
    for (const JointAngles& q_left : left.solutions) {
      const InverseKinematics right = solve(stop, kRight, q_left);
      if (right.solutions.empty()) {
        reason = "for the right image " + right.reason;
        continue;
      }
      const Posture posture = {q_left, nearest(right.solutions, q_left)};
      auto touch = clearance_.touch(posture[kLeft], margin_m_);
      if (!touch) touch = clearance_.touch(posture[kRight], margin_m_);
      if (touch) {
        if (touched.empty()) touched = *touch;
      } else {
        postures.push_back(posture);
      }
    }
    if (!postures.empty()) return postures;
    tell(stop, touched.empty() ? reason : touched,
         touched.empty() ? "a place and a look direction that the arm can reach"
                         : fmt::format("a pose at which the arm stays {} m clear of everything", margin_m_));
    return postures;
  }

  /// Says what is wrong with a stop, unless a generated neighbour before it had the same trouble.
  void tell(const CameraStop& stop, const std::string& why, const std::string& wanted) {
    in_vain_.insert(wanted);
    if (scenario_.plan.path && in_vain_before_.contains(wanted)) return;
    problems_.push_back(
        {scenario_.file, stop.line, stop.key, fmt::format("{}: {}", place_of(stop), why), wanted});
  }
  void go_to_next_stop() { in_vain_before_ = std::exchange(in_vain_, {}); }

  /// The sequence of least effort (Viterbi), then every angle in the turn nearest to the one before.
  void choose() {
    const size_t n = postures_.size();
    std::vector<std::vector<double>> cost(n);
    std::vector<std::vector<size_t>> from(n);
    cost[0].assign(postures_[0].size(), 0);
    for (size_t i = 1; i < n; ++i) {
      for (const Posture& posture : postures_[i]) {
        double least = std::numeric_limits<double>::infinity();
        size_t best = 0;
        for (size_t j = 0; j < postures_[i - 1].size(); ++j) {
          const double total = cost[i - 1][j] + effort(postures_[i - 1][j][kRight], posture[kLeft]);
          if (total < least) least = total, best = j;
        }
        cost[i].push_back(least);
        from[i].push_back(best);
      }
    }
    plan_.q.resize(n);
    auto at =
        static_cast<size_t>(std::min_element(cost[n - 1].begin(), cost[n - 1].end()) - cost[n - 1].begin());
    for (size_t i = n; i-- > 0;) {
      plan_.q[i] = postures_[i][at];
      if (i > 0) at = from[i][at];
    }
    JointAngles near = plan_.q[0][kLeft];
    for (size_t i = 0; i < n; ++i) {
      for (const Side side : {kLeft, kRight}) {
        plan_.q[i][side] = nearest(solve(plan_.stops[i], side, near).solutions, plan_.q[i][side]);
        near = plan_.q[i][side];
      }
    }
  }

  /// Joints run straight from image to image; no point of the arm goes farther between two looks than twice
  /// the clearance.
  void check_way_to(size_t stop) {
    if (stop > 0) {
      check_way(plan_.q[stop - 1][kRight], plan_.q[stop][kLeft], plan_.stops[stop]);
      check_time(stop);
    }
    check_way(plan_.q[stop][kLeft], plan_.q[stop][kRight], plan_.stops[stop]);
  }

  /// Two motions, and coming to rest after each, must fit between two pairs.
  void check_time(size_t stop) {
    const CameraStop &from = plan_.stops[stop - 1], &to = plan_.stops[stop];
    const slam::Pose T_world_right = ArmPlan::T_world_camera(from, kRight, baseline_m_);
    const double way_m = (to.T_world_left.translation() - T_world_right.translation()).norm();
    const double speed_mps = scenario_.scale * scenario_.plan.speed_mps;
    const double moving_s =
        ArmServo::duration_s(arm_, plan_.q[stop][kLeft] - plan_.q[stop - 1][kRight], way_m / speed_mps) +
        ArmServo::duration_s(arm_, plan_.q[stop][kRight] - plan_.q[stop][kLeft], baseline_m_ / speed_mps);
    if (moving_s + 2 * kUsualRest_s < period_s_) return;
    tell(to, fmt::format("the arm moves for {:.2f} s to be there twice", moving_s),
         fmt::format(
             "{:.2f} s at most: the head's time between pairs, less {} s to come to rest after each motion",
             period_s_ - 2 * kUsualRest_s, kUsualRest_s));
  }

  void check_way(const JointAngles& from, const JointAngles& to, const CameraStop& stop) {
    const double lever_m = arm_.geometry.reach_m() + arm_.geometry.d4_m + arm_.geometry.d5_m +
                           arm_.geometry.d6_m + arm_.T_flange_camera.translation().norm();
    const double longest_m = (to - from).cwiseAbs().sum() * lever_m;
    const double looks = std::ceil(longest_m / (2 * margin_m_));
    for (double look = 1; look < looks; ++look) {
      const auto touch = clearance_.touch(from + look / looks * (to - from), margin_m_);
      if (!touch) continue;
      tell(stop, "on the way to it " + *touch,
           fmt::format("a way that stays {} m clear of everything", margin_m_));
      return;
    }
  }

  const Scenario& scenario_;
  const ArmModel& arm_;
  const ArmClearance clearance_;
  const double margin_m_;
  const double baseline_m_;
  const double period_s_;
  ArmPlan plan_;
  std::vector<std::vector<Posture>> postures_;  ///< by stop
  std::set<std::string> in_vain_,
      in_vain_before_;  ///< what was wanted of this stop, and of the one before it
  std::vector<Problem> problems_;
};

}  // namespace

slam::Pose ArmPlan::T_world_camera(const CameraStop& stop, Side side, double baseline_m) {
  return stop.T_world_left * Eigen::Translation3d(side == kRight ? baseline_m : 0, 0, 0);
}

ArmPlan plan_arm(const Scenario& scenario, const World& world, const ArmModel& arm, double baseline_m,
                 int64_t period_ns) {
  return Planner(scenario, world, arm, baseline_m, period_ns).make();
}

}  // namespace groundloop::sim
