// Uncertainty is honest: errors of many windows, normalised by the reported covariances, are chi-square.
#include <gtest/gtest.h>

#include "slam/adjustment/window_adjustment.h"
#include "tests/slam/adjustment/synthetic_window.h"

namespace groundloop::slam {
namespace {

/// Bounds of the mean of n chi-square deviates, 95 %; the deviates have variance 2 x degrees of freedom.
double margin(int degrees, int n) { return 1.96 * std::sqrt(2.0 * degrees / n); }

struct Trials {
  double nees_newest = 0, nees_all = 0;  ///< mean of e^T C^-1 e: of the newest motion, and of all of them
};

Trials run(const WindowRecipe& recipe, double lorentz_scale, int trials) {
  const StereoRig rig = pioneer_rig();
  AdjustmentOptions options;
  options.lorentz_scale = lorentz_scale;
  options.max_iterations = 30;
  WindowAdjustment adjustment(rig, options);
  AdjustmentResult result;
  Trials mean;
  for (int i = 0; i < trials; ++i) {
    WindowRecipe r = recipe;
    r.seed = 5000 + static_cast<uint64_t>(i);
    const SyntheticWindow window = make_window(rig, r);
    adjustment.solve(window.problem, result);
    EXPECT_TRUE(result.usable) << result.message;
    const size_t newest = window.T_odom_left.size() - 1;
    for (size_t k = 1; k <= newest; ++k) {
      const Pose truth = window.T_odom_left[k - 1].inverse() * window.T_odom_left[k];
      const Pose found = result.T_odom_left[k - 1].inverse() * result.T_odom_left[k];
      const Vector6d e = se3_log(found.inverse() * truth);
      const double nees = e.dot(result.motion_covariance[k].ldlt().solve(e));
      mean.nees_all += nees / static_cast<double>(newest) / trials;
      if (k == newest) mean.nees_newest += nees / trials;
    }
  }
  return mean;
}

TEST(WindowUncertainty, ErrorsOfTheMotionsAreWhatItSays) {
  for (const double lorentz_scale : {1.0, 2.0}) {
    const Trials mean = run({.landmarks = 120}, lorentz_scale, 200);
    EXPECT_NEAR(mean.nees_newest, 6, margin(6, 200)) << "scale " << lorentz_scale;
    EXPECT_NEAR(mean.nees_all, 6, margin(6, 200)) << "scale " << lorentz_scale;
    printf("scale %.0f: NEES newest %.2f, all %.2f\n", lorentz_scale, mean.nees_newest, mean.nees_all);
  }
}

TEST(WindowUncertainty, AlsoAmongFalseMatches) {
  for (const double lorentz_scale : {1.0, 2.0}) {
    const Trials mean = run({.landmarks = 120, .outliers = 0.1}, lorentz_scale, 200);
    EXPECT_NEAR(mean.nees_newest, 6, margin(6, 200)) << "scale " << lorentz_scale;
    EXPECT_NEAR(mean.nees_all, 6, margin(6, 200)) << "scale " << lorentz_scale;
    printf("scale %.0f: NEES newest %.2f, all %.2f\n", lorentz_scale, mean.nees_newest, mean.nees_all);
  }
}

TEST(WindowUncertainty, TheMisfitsTellHowWrongTheStatedSigmaIs) {
  for (const double sigma_px : {0.1, 0.3}) {
    const Trials mean = run({.landmarks = 120, .sigma_px = sigma_px}, 2, 200);
    EXPECT_NEAR(mean.nees_all, 6, margin(6, 200)) << "sigma " << sigma_px;
    printf("sigma %.1f px: NEES newest %.2f, all %.2f\n", sigma_px, mean.nees_newest, mean.nees_all);
  }
}

TEST(WindowUncertainty, ErrorsOfLandmarksSeenByAnchorsAreWhatItSays) {
  // Poses that are exact: conditional and marginal covariance are the same.
  const StereoRig rig = pioneer_rig();
  AdjustmentOptions options;
  options.max_iterations = 30;
  WindowAdjustment adjustment(rig, options);
  AdjustmentResult result;
  double sum = 0;
  int landmarks = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SyntheticWindow window = make_window(rig, {.key_frames = 6, .landmarks = 120, .seed = seed});
    for (size_t k = 0; k + 1 < 6; ++k) window.problem.key_frames[k] = {window.T_odom_left[k], true};
    std::vector<int> seen(window.landmarks_odom.size(), 0);
    for (const AdjustmentObservation& o : window.problem.observations) {
      if (o.key_frame == 5) seen[static_cast<size_t>(o.landmark)] = -100;
      ++seen[static_cast<size_t>(o.landmark)];
    }
    adjustment.solve(window.problem, result);
    ASSERT_TRUE(result.usable) << result.message;
    for (size_t j = 0; j < seen.size(); ++j) {
      if (seen[j] < 3) continue;
      const Eigen::Vector3d e = result.landmarks_odom[j] - window.landmarks_odom[j];
      sum += e.dot(result.landmark_covariance[j].ldlt().solve(e));
      ++landmarks;
    }
  }
  ASSERT_GT(landmarks, 200);
  printf("NEES of %d landmarks %.2f\n", landmarks, sum / landmarks);
  EXPECT_NEAR(sum / landmarks, 3, 0.5);
}

}  // namespace
}  // namespace groundloop::slam
