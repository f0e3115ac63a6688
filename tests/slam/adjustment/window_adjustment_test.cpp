#include "slam/adjustment/window_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "tests/slam/adjustment/ceres_window.h"
#include "tests/slam/adjustment/synthetic_window.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

AdjustmentResult adjust(const AdjustmentOptions& options, const AdjustmentProblem& problem) {
  AdjustmentResult result;
  WindowAdjustment(pioneer_rig(), options).solve(problem, result);
  return result;
}

AdjustmentOptions patient() {
  AdjustmentOptions options;
  options.max_iterations = 200;
  options.lorentz_scale = 2;
  return options;
}

/// Largest difference of poses (as twist) and of landmarks.
double difference(const AdjustmentResult& result, const std::vector<Pose>& T_odom_left,
                  const std::vector<Eigen::Vector3d>& landmarks_odom) {
  double largest = 0;
  for (size_t k = 0; k < T_odom_left.size(); ++k) {
    largest = std::max(largest, se3_log(result.T_odom_left[k].inverse() * T_odom_left[k]).norm());
  }
  for (size_t j = 0; j < landmarks_odom.size(); ++j) {
    largest = std::max(largest, (result.landmarks_odom[j] - landmarks_odom[j]).norm());
  }
  return largest;
}

TEST(ObservationTerms, AreThoseOfFiniteDifferences) {
  StereoRig rig = pioneer_rig();
  rig.fy_px = 560;
  rig.cx_right_px = 330;
  const Pose T_odom_left = se3_exp((Vector6d() << 1, 2, 3, 0.4, -0.5, 0.6).finished());
  const Eigen::Vector3d p_odom = T_odom_left * Eigen::Vector3d(0.4, -0.3, 2.5);
  const Eigen::Vector3d uvu = rig.project({0.4, -0.3, 2.5}) + Eigen::Vector3d(1.5, -2, 0.7);
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d W;  // of errors that the three coordinates have in common
  W << 12, 2, -4, 2, 25, 3, -4, 3, 9;
  ObservationTerms terms;
  ASSERT_TRUE(observation_terms(rig, T_odom_left, p_odom, uvu, W, terms));

  const auto projected = [&](const Vector6d& twist, const Eigen::Vector3d& move) {
    return rig.project((T_odom_left * se3_exp(twist)).inverse() * (p_odom + move));
  };
  Eigen::Matrix<double, 3, 6> J_x;
  Eigen::Matrix3d J_l;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = kStep * Vector6d::Unit(i);
    J_x.col(i) =
        (projected(d, Eigen::Vector3d::Zero()) - projected(-d, Eigen::Vector3d::Zero())) / (2 * kStep);
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
    J_l.col(i) = (projected(Vector6d::Zero(), d) - projected(Vector6d::Zero(), -d)) / (2 * kStep);
  }
  const Eigen::Vector3d r = uvu - rig.project({0.4, -0.3, 2.5});
  EXPECT_NEAR(terms.s, 102.61, 1e-9);  // of (1.5, -2, 0.7)
  EXPECT_LT((terms.H_xx - J_x.transpose() * W * J_x).norm(), 1e-7 * terms.H_xx.norm());
  EXPECT_LT((terms.H_xl - J_x.transpose() * W * J_l).norm(), 1e-7 * terms.H_xl.norm());
  EXPECT_LT((terms.H_ll - J_l.transpose() * W * J_l).norm(), 1e-7 * terms.H_ll.norm());
  EXPECT_LT((terms.g_x - J_x.transpose() * W * r).norm(), 1e-7 * terms.g_x.norm());
  EXPECT_LT((terms.g_l - J_l.transpose() * W * r).norm(), 1e-7 * terms.g_l.norm());
}

TEST(ObservationTerms, APointMovesWithTheRightCameraAsFiniteDifferencesSay) {
  StereoRig rig = pioneer_rig();
  rig.fy_px = 560;
  rig.cx_right_px = 330;
  const Eigen::Vector3d p_left(0.4, -0.3, 2.5);
  const auto triangulated = [&](const Vector6d& twist) {
    return *rig.triangulate(project_with(rig, twist, p_left));
  };
  const Matrix36d J = moved_by_right_camera(rig, p_left);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = kStep * Vector6d::Unit(i);
    const Eigen::Vector3d slope = (triangulated(d) - triangulated(-d)) / (2 * kStep);
    EXPECT_LT((J.col(i) - slope).norm(), 1e-6 * (1 + slope.norm())) << "axis " << i;
  }
}

TEST(ObservationTerms, BehindTheCameraThereIsNothingToSee) {
  ObservationTerms terms;
  const Pose I = Pose::Identity();
  EXPECT_FALSE(
      observation_terms(pioneer_rig(), I, {0, 0, -1}, {1, 2, 3}, Eigen::Matrix3d::Identity(), terms));
  EXPECT_EQ(terms.s, kNotInView);
  EXPECT_EQ(terms.H_ll, Eigen::Matrix3d::Zero());
  EXPECT_FALSE(observation_terms(pioneer_rig(), I, {0, 0, std::nan("")}, {1, 2, 3},
                                 Eigen::Matrix3d::Identity(), terms));
}

TEST(WindowAdjustment, ExactDataGiveTheExactWindow) {
  const SyntheticWindow window = make_window(pioneer_rig(), {.sigma_px = 0});
  SyntheticWindow off = window;
  for (size_t j = 0; j < off.problem.landmarks_odom.size(); ++j) {
    const Eigen::Vector3d direction(gaussian(3, 1, j), gaussian(3, 2, j), gaussian(3, 3, j));
    off.problem.landmarks_odom[j] += 0.05 * direction;
  }
  const AdjustmentResult result = adjust(patient(), off.problem);
  ASSERT_TRUE(result.usable) << result.message;
  EXPECT_LT(difference(result, window.T_odom_left, window.landmarks_odom), 1e-9);
  EXPECT_LT(result.cost_after, 1e-12);
  EXPECT_GT(result.cost_before, 1);
  EXPECT_EQ(result.inliers, static_cast<int>(window.problem.observations.size()));
  EXPECT_TRUE(result.T_odom_left[0].isApprox(window.T_odom_left[0]));
}

TEST(WindowAdjustment, FewIterationsAreNearlyAll) {
  // What is left after five iterations from a cold start is small beside the uncertainty of the answer.
  const SyntheticWindow window = make_window(pioneer_rig(), {.outliers = 0.05});
  for (const double lorentz_scale : {1.0, 2.0}) {
    AdjustmentOptions few, all = patient();
    few.max_iterations = 5;
    few.lorentz_scale = all.lorentz_scale = lorentz_scale;
    const AdjustmentResult quick = adjust(few, window.problem), full = adjust(all, window.problem);
    ASSERT_TRUE(quick.usable && full.usable);
    EXPECT_EQ(quick.iterations, 5);
    for (size_t k = 1; k < full.T_odom_left.size(); ++k) {
      const Pose a = quick.T_odom_left[k - 1].inverse() * quick.T_odom_left[k];
      const Pose b = full.T_odom_left[k - 1].inverse() * full.T_odom_left[k];
      const Vector6d e = se3_log(a.inverse() * b);
      EXPECT_LT(e.dot(full.motion_covariance[k].ldlt().solve(e)), 0.6) << "key frame " << k;  // a tenth of 6
    }
  }
}

/// Motions as a plan would know them: 2 % off.
std::vector<MotionPrior> plan_of(const std::vector<Pose>& T_odom_left) {
  std::vector<MotionPrior> motions;
  for (int k = 1; k < static_cast<int>(T_odom_left.size()); ++k) {
    const auto to = static_cast<size_t>(k);
    Vector6d twist = se3_log(T_odom_left[to - 1].inverse() * T_odom_left[to]);
    twist *= 1.02;
    const Pose T_from_to = se3_exp(twist);
    motions.push_back({k - 1, k, T_from_to, planned_motion_covariance(T_from_to, 0.02)});
  }
  return motions;
}

TEST(WindowAdjustment, AgreesWithCeres) {
  for (const uint64_t seed : {1, 2, 3}) {
    SyntheticWindow window = make_window(pioneer_rig(), {.outliers = 0.1, .seed = seed});
    if (seed == 2) window.problem.motions = plan_of(window.T_odom_left);
    if (seed == 3) {  // a second anchor
      window.problem.key_frames[1] = {window.T_odom_left[1], true};
    }
    const AdjustmentResult ours = adjust(patient(), window.problem);
    const AdjustmentResult theirs = ceres_window(pioneer_rig(), patient(), window.problem, 1e-15);
    ASSERT_TRUE(ours.usable) << ours.message;
    EXPECT_NEAR(ours.cost_before, theirs.cost_before, 1e-9 * theirs.cost_before);
    EXPECT_NEAR(ours.cost_after, theirs.cost_after, 1e-8 * theirs.cost_after);
    EXPECT_LT(difference(ours, theirs.T_odom_left, {}), 1e-6) << "seed " << seed;
  }
}

/// Derivative of the cost by the twist of one key frame, from the problem's side.
Vector6d gradient(const AdjustmentOptions& options, AdjustmentProblem problem, size_t key_frame) {
  AdjustmentOptions look = options;
  look.max_iterations = 1;
  Vector6d g;
  const Pose T = problem.key_frames[key_frame].T_odom_left;
  for (int i = 0; i < 6; ++i) {
    double cost[2];
    for (int side = 0; side < 2; ++side) {
      problem.key_frames[key_frame].T_odom_left = T * se3_exp((side == 0 ? -1e-6 : 1e-6) * Vector6d::Unit(i));
      cost[side] = adjust(look, problem).cost_before;
    }
    g(i) = (cost[1] - cost[0]) / 2e-6;
  }
  return g;
}

TEST(WindowAdjustment, EndsWhereTheWholeCostIsFlat) {
  SyntheticWindow window = make_window(pioneer_rig(), {.landmarks = 60});
  window.problem.motions = plan_of(window.T_odom_left);
  window.problem.plane.normal_odom = so3_exp({0.02, -0.03, 0}) * Eigen::Vector3d::UnitZ();
  window.problem.plane.offset_m = 0.03;
  AdjustmentOptions options = patient();
  options.planar_height_sigma_m = 0.01;
  options.planar_tilt_sigma_deg = 0.3;
  const AdjustmentResult result = adjust(options, window.problem);
  ASSERT_TRUE(result.usable) << result.message;
  AdjustmentProblem there = window.problem;
  there.landmarks_odom = result.landmarks_odom;
  for (size_t k = 1; k < there.key_frames.size(); ++k)
    there.key_frames[k].T_odom_left = result.T_odom_left[k];
  for (size_t k = 1; k < there.key_frames.size(); ++k) {
    const double before = gradient(options, window.problem, k).norm();
    EXPECT_GT(before, 100);
    EXPECT_LT(gradient(options, there, k).norm(), 1e-4 * before) << "key frame " << k;
  }
}

TEST(WindowAdjustment, NamesTheOutliersAndIsHardlyMovedByThem) {
  const SyntheticWindow clean = make_window(pioneer_rig(), {.landmarks = 300, .seed = 5});
  const SyntheticWindow foul = make_window(pioneer_rig(), {.landmarks = 300, .outliers = 0.15, .seed = 5});
  const AdjustmentResult result = adjust(patient(), foul.problem);
  ASSERT_TRUE(result.usable) << result.message;
  // One false observation among four or more can be told, if it is not the one that the landmark starts from.
  std::vector<int> seen(foul.landmarks_odom.size(), 0), false_ones = seen;
  for (size_t n = 0; n < foul.is_outlier.size(); ++n) {
    const auto j = static_cast<size_t>(foul.problem.observations[n].landmark);
    false_ones[j] += foul.is_outlier[n] * (seen[j] == 0 ? 2 : 1);
    ++seen[j];
  }
  int kept = 0, lost = 0, outliers = 0, good = 0;
  for (size_t n = 0; n < foul.is_outlier.size(); ++n) {
    const auto j = static_cast<size_t>(foul.problem.observations[n].landmark);
    if (seen[j] < 4 || false_ones[j] > 1) continue;
    outliers += foul.is_outlier[n];
    good += 1 - foul.is_outlier[n];
    kept += foul.is_outlier[n] && result.inlier[n];
    lost += !foul.is_outlier[n] && !result.inlier[n];
  }
  printf("%d of %d outliers kept, %d of %d others lost\n", kept, outliers, lost, good);
  ASSERT_GT(outliers, 30);
  EXPECT_LT(kept, 0.05 * outliers);
  EXPECT_LT(lost, 0.01 * good);
  const auto error = [](const AdjustmentResult& r, const SyntheticWindow& w) {
    return se3_log(r.T_odom_left.back().inverse() * w.T_odom_left.back()).norm();
  };
  EXPECT_LT(error(result, foul), 3 * error(adjust(patient(), clean.problem), clean));
}

TEST(WindowAdjustment, ASoftFloorTakesAwayHeightAndTilt) {
  const StereoRig rig = pioneer_rig();
  AdjustmentOptions soft = patient();
  soft.planar_height_sigma_m = 1e-4;
  soft.planar_tilt_sigma_deg = 0.005;
  double sum2[2] = {0, 0};
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticWindow window = make_window(rig, {.landmarks = 60, .seed = seed});
    const AdjustmentResult results[2] = {adjust(patient(), window.problem), adjust(soft, window.problem)};
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(results[i].usable) << results[i].message;
      const Pose T_odom_body = results[i].T_odom_left.back() * rig.T_body_left.inverse();
      sum2[i] += T_odom_body.translation().z() * T_odom_body.translation().z();
      if (i == 1) {
        EXPECT_LT(std::abs(T_odom_body.linear()(2, 0)), 0.02 * kDeg);
        EXPECT_LT(std::abs(T_odom_body.linear()(2, 1)), 0.02 * kDeg);
      }
    }
  }
  EXPECT_LT(sum2[1], 0.25 * sum2[0]);
}

TEST(WindowAdjustment, AKeyFrameWithoutLandmarksFollowsThePlan) {
  SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 4});
  std::erase_if(window.problem.observations, [](const AdjustmentObservation& o) { return o.key_frame == 3; });
  window.problem.motions = {plan_of(window.T_odom_left)[2]};
  const AdjustmentResult result = adjust(patient(), window.problem);
  ASSERT_TRUE(result.usable) << result.message;
  const Pose moved = result.T_odom_left[2].inverse() * result.T_odom_left[3];
  EXPECT_LT(se3_log(moved.inverse() * window.problem.motions[0].T_from_to).norm(), 1e-9);
  EXPECT_LT((result.motion_covariance[3] - window.problem.motions[0].covariance).norm(),
            1e-6 * window.problem.motions[0].covariance.norm());
}

TEST(WindowAdjustment, ALandmarkSeenOnceIsWhereItWasSeen) {
  SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 4});
  const Eigen::Vector3d p_left(0.3, -0.2, 2);
  const int landmark = static_cast<int>(window.problem.landmarks_odom.size());
  window.problem.landmarks_odom.push_back(window.T_odom_left[3] * (p_left + Eigen::Vector3d(0.1, 0.1, 0.3)));
  const AdjustmentResult without = adjust(patient(), window.problem);
  window.problem.observations.push_back({3, landmark, pioneer_rig().project(p_left), 0.2});
  const AdjustmentResult result = adjust(patient(), window.problem);
  ASSERT_TRUE(result.usable && without.usable);
  EXPECT_LT((result.T_odom_left[3].inverse() * result.landmarks_odom.back() - p_left).norm(), 1e-6);
  EXPECT_LT(difference(result, without.T_odom_left, {}), 1e-8);  // it has no say
  // One that was never seen stays, and says that nothing is known of it.
  EXPECT_EQ(without.landmarks_odom.back(), window.problem.landmarks_odom.back());
  EXPECT_EQ(without.landmark_covariance.back(), Eigen::Matrix3d::Zero());
  EXPECT_GT(result.landmark_covariance.back().determinant(), 0);
}

TEST(WindowAdjustment, OrderAndHistoryDoNotMatter) {
  const SyntheticWindow window = make_window(pioneer_rig(), {.outliers = 0.1});
  const AdjustmentResult first = adjust({}, window.problem);
  WindowAdjustment used(pioneer_rig(), {});
  AdjustmentResult again;
  used.solve(make_window(pioneer_rig(), {.key_frames = 12, .landmarks = 300, .seed = 9}).problem, again);
  SyntheticWindow turned = window;
  std::reverse(turned.problem.observations.begin(), turned.problem.observations.end());
  used.solve(turned.problem, again);
  for (size_t k = 0; k < first.T_odom_left.size(); ++k) {
    EXPECT_EQ(first.T_odom_left[k].matrix(), again.T_odom_left[k].matrix());
    EXPECT_EQ(first.motion_covariance[k], again.motion_covariance[k]);
  }
  EXPECT_EQ(first.landmarks_odom, again.landmarks_odom);
  EXPECT_EQ(first.inlier, std::vector<uint8_t>(again.inlier.rbegin(), again.inlier.rend()));
  EXPECT_EQ(first.cost_after, again.cost_after);
}

/// Refused: with a reason, and with what went in.
void expect_refused(const AdjustmentProblem& problem, const std::string& message) {
  const AdjustmentResult result = adjust({}, problem);
  EXPECT_FALSE(result.usable);
  EXPECT_EQ(result.message, message);
  ASSERT_EQ(result.T_odom_left.size(), problem.key_frames.size());
  for (size_t k = 0; k < problem.key_frames.size(); ++k) {
    EXPECT_EQ(result.T_odom_left[k].matrix(), problem.key_frames[k].T_odom_left.matrix());
  }
  EXPECT_EQ(result.landmarks_odom, problem.landmarks_odom);
  EXPECT_EQ(result.inlier.size(), problem.observations.size());
}

TEST(WindowAdjustment, SaysWhatIsMissing) {
  expect_refused({}, "no key frame");
  const SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 4});
  AdjustmentProblem p = window.problem;
  p.key_frames[0].fixed = false;
  expect_refused(p, "no key frame is fixed");
  for (AdjustmentKeyFrame& frame : p.key_frames) frame.fixed = true;
  expect_refused(p, "every key frame is fixed");
  p = window.problem;
  p.landmarks_odom.clear();
  p.observations.clear();
  expect_refused(p, "key frame 1 shares no landmark with another");
  p = window.problem;
  std::erase_if(p.observations, [](const AdjustmentObservation& o) { return o.key_frame == 2; });
  expect_refused(p, "key frame 2 shares no landmark with another");
}

TEST(WindowAdjustment, SaysWhatIsWrong) {
  const SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 4, .landmarks = 20});
  AdjustmentProblem p = window.problem;
  p.observations[3].key_frame = 4;
  p.observations[3].landmark = 7;
  expect_refused(p, "observation 3 names key frame 4 of 4, landmark 7 of 20");
  p = window.problem;
  p.observations[2].sigma_px = 0;
  p.observations[2].uvu_px = {1, 2, 3};
  expect_refused(p, "observation 2 has a sigma of 0 px at (1, 2, 3)");
  p = window.problem;
  p.observations[5].cofactor = Eigen::Vector3d(1, 0, 1).asDiagonal();
  expect_refused(p, "observation 5 has a cofactor that is no covariance");
  p = window.problem;
  const AdjustmentObservation twice = p.observations.front();
  p.observations.push_back(twice);
  expect_refused(p, "landmark 0 is observed twice in key frame " + std::to_string(twice.key_frame));
  p = window.problem;
  p.motions.push_back({0, 5, Pose::Identity(), Matrix6d::Identity()});
  expect_refused(p, "motion 0 leads from key frame 0 to key frame 5 of 4");
}

TEST(WindowAdjustment, SaysThatAWindowIsOpen) {
  // Two landmarks in all: the rotation about the line through them is anyone's guess.
  SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 3, .landmarks = 2, .sigma_px = 0});
  AdjustmentProblem p = window.problem;
  p.observations.clear();
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 2; ++j) {
      p.landmarks_odom[static_cast<size_t>(j)] = Eigen::Vector3d(2 + j, 0.2 * j, 0.3);
      const Pose& T_odom_left = window.T_odom_left[static_cast<size_t>(k)];
      const Eigen::Vector3d p_left = T_odom_left.inverse() * p.landmarks_odom[static_cast<size_t>(j)];
      p.observations.push_back({k, j, pioneer_rig().project(p_left), 0.2});
    }
  }
  expect_refused(p, "the observations do not determine the key frames");
}

TEST(WindowAdjustment, LandmarksBehindTheCameraOrAtInfinityDoNotSpoilTheRest) {
  SyntheticWindow window = make_window(pioneer_rig(), {.key_frames = 5});
  AdjustmentProblem p = window.problem;
  const int landmark = static_cast<int>(p.landmarks_odom.size());
  p.landmarks_odom.push_back(window.T_odom_left[0] * Eigen::Vector3d(0, 0, -2));
  p.landmarks_odom.push_back(window.T_odom_left[0] * Eigen::Vector3d(0, 0, 1e7));
  for (int k = 0; k < 5; ++k) {
    p.observations.push_back({k, landmark, {300, 200, 280}, 0.2});
    p.observations.push_back({k, landmark + 1, {300.0 + k, 200, 300.0 + k}, 0.2});
  }
  const AdjustmentResult with = adjust(patient(), p), without = adjust(patient(), window.problem);
  ASSERT_TRUE(with.usable) << with.message;
  EXPECT_LT(difference(with, without.T_odom_left, {}), 1e-6);
  EXPECT_EQ(with.inlier[with.inlier.size() - 2], 0);
}

}  // namespace
}  // namespace groundloop::slam
