// Trajectories whose errors follow from school geometry, so that the answers are known before they are asked
// for.
#include "bench/metrics/pose_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bench/metrics/path.h"
#include "bench/metrics/statistics.h"
#include "slam/types/counter_random.h"
#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr PoseRelation kAllRelations[] = {
    PoseRelation::kTranslationPart, PoseRelation::kRotationPart, PoseRelation::kFull,
    PoseRelation::kAngleDeg,        PoseRelation::kAngleRad,     PoseRelation::kPointDistance};

PosePairs one_pair(const slam::Pose& truth, const slam::Pose& estimate) {
  return {{at(0, truth)}, {at(0, estimate)}};
}

TEST(AbsoluteErrors, OfAKnownMotion) {
  // E turns by 40 degrees and moves by 3-4-12 (13 m): |R - I| = 2 sqrt(2) sin(20 deg)
  const slam::Pose truth = moved(1, 2, 3) * turned(77, {1, 2, -1});
  const slam::Pose estimate = truth * moved(3, 4, 12) * turned(40, {1, -1, 0.5});
  const PosePairs pairs = one_pair(truth, estimate);
  const double rotation_part = 2 * std::sqrt(2) * std::sin(20 * kRadPerDeg);
  const auto error = [&](PoseRelation relation) { return absolute_errors(pairs, relation).at(0); };
  EXPECT_NEAR(error(PoseRelation::kTranslationPart), 13, 1e-12);
  EXPECT_NEAR(error(PoseRelation::kPointDistance), 13, 1e-12);
  EXPECT_NEAR(error(PoseRelation::kAngleDeg), 40, 1e-12);
  EXPECT_NEAR(error(PoseRelation::kAngleRad), 40 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(error(PoseRelation::kRotationPart), rotation_part, 1e-12);
  EXPECT_NEAR(error(PoseRelation::kFull), std::hypot(13, rotation_part), 1e-12);
}

TEST(AbsoluteErrors, AngleIsExactAtBothEnds) {
  const auto angle_deg = [](double by_deg) {
    const slam::Pose truth = turned(33, {0.2, 0.4, 1});
    return absolute_errors(one_pair(truth, truth * turned(by_deg, {1, 0.1, 3})), PoseRelation::kAngleDeg)
        .at(0);
  };
  EXPECT_NEAR(angle_deg(0), 0, 1e-13);
  EXPECT_NEAR(angle_deg(1e-7), 1e-7, 1e-13);
  EXPECT_NEAR(angle_deg(179.9999999), 179.9999999, 1e-11);
  EXPECT_NEAR(angle_deg(180), 180, 1e-11);
  EXPECT_NEAR(angle_deg(270), 90, 1e-11);
}

TEST(AbsoluteErrors, OfEqualTrajectoriesAreZero) {
  const PosePairs pairs{circle(9, 2), circle(9, 2)};
  for (const PoseRelation relation : kAllRelations) {
    for (const double error : absolute_errors(pairs, relation)) EXPECT_LT(error, 1e-14);
  }
}

// The small sample: a circle of radius 2 m in 36 steps. The estimate alternates 5 mm above and below it and
// turns 0.5 degrees a step too far about its own vertical.
PosePairs sample() {
  PosePairs pairs{circle(36, 2), circle(36, 2)};
  for (int i = 0; i < 36; ++i) {
    pairs.estimate[i].T = moved(0, 0, i % 2 == 0 ? 0.005 : -0.005) * pairs.estimate[i].T *
                          turned(0.5 * i, Eigen::Vector3d::UnitZ());
  }
  return pairs;
}

TEST(Sample, AbsoluteTranslation) {
  const Statistics s = statistics(absolute_errors(sample(), PoseRelation::kTranslationPart));
  EXPECT_NEAR(s.rmse, 0.005, 1e-12);
  EXPECT_NEAR(s.std, 0, 1e-12);
  EXPECT_NEAR(s.sse, 0.0009, 1e-12);  // 36 * 0.005^2
}

TEST(Sample, AbsoluteAngle) {
  const Statistics s = statistics(absolute_errors(sample(), PoseRelation::kAngleDeg));
  EXPECT_NEAR(s.min, 0, 1e-9);
  EXPECT_NEAR(s.max, 17.5, 1e-9);
  EXPECT_NEAR(s.mean, 8.75, 1e-9);
  EXPECT_NEAR(s.median, 8.75, 1e-9);
  EXPECT_NEAR(s.std, 5.1941473474158, 1e-9);  // 0.5 sqrt((36^2 - 1) / 12)
}

TEST(Sample, RelativeAngleOverOneAndTenFrames) {
  RelativeOptions options{.relation = PoseRelation::kAngleDeg};
  EXPECT_NEAR(statistics(relative_errors(sample(), options)).mean, 0.5, 1e-9);
  options.delta = 10;
  options.all_pairs = true;
  const auto errors = relative_errors(sample(), options);
  EXPECT_EQ(errors.size(), 26u);
  EXPECT_NEAR(statistics(errors).mean, 5, 1e-9);
}

TEST(Sample, RelativePointDistance) {
  // chord of 10 degrees c = 4 sin(5 deg) against sqrt(c^2 + 0.01^2)
  const double chord_m = 4 * std::sin(5 * kRadPerDeg);
  const Statistics s = statistics(relative_errors(sample(), {.relation = PoseRelation::kPointDistance}));
  EXPECT_NEAR(s.mean, std::hypot(chord_m, 0.01) - chord_m, 1e-12);
  EXPECT_NEAR(s.max, 0.00014339192634, 1e-13);
}

TEST(Sample, RelativeTranslation) {
  // In the frame of pose i the true chord c is turned by the heading error of pose i, 0.5 i degrees, and
  // lifted.
  const double chord_m = 4 * std::sin(5 * kRadPerDeg);
  const auto errors = relative_errors(sample(), {.relation = PoseRelation::kTranslationPart});
  ASSERT_EQ(errors.size(), 35u);
  for (int i = 0; i < 35; ++i) {
    EXPECT_NEAR(errors[i], std::hypot(2 * chord_m * std::sin(0.25 * i * kRadPerDeg), 0.01), 1e-12) << i;
  }
}

TEST(RelativeErrors, DoNotSeeARigidMotionOfTheWholeEstimate) {
  PosePairs shifted = sample();
  for (auto& pose : shifted.estimate) pose.T = moved(5, 6, 7) * turned(100, {1, 1, 0}) * pose.T;
  for (const PoseRelation relation : kAllRelations) {
    const auto plain = relative_errors(sample(), {.relation = relation});
    const auto moved_along = relative_errors(shifted, {.relation = relation});
    ASSERT_EQ(plain.size(), moved_along.size());
    for (size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(plain[i], moved_along[i], 1e-11);
  }
}

TEST(SubTrajectories, ByFrames) {
  EXPECT_THAT(sub_trajectories(straight(8, 1), {.delta = 3}), ElementsAre(Pair(0, 3), Pair(3, 6)));
  EXPECT_THAT(sub_trajectories(straight(6, 1), {.delta = 3, .all_pairs = true}),
              ElementsAre(Pair(0, 3), Pair(1, 4), Pair(2, 5)));
  EXPECT_THAT(sub_trajectories(straight(3, 1), {.delta = 3}), ElementsAre());
}

TEST(SubTrajectories, ByMetresOneAfterTheOther) {
  // The first starts where 2.5 m have been travelled for the first time: at the pose at 3 m.
  EXPECT_THAT(sub_trajectories(straight(11, 1), {.delta = 2.5, .unit = DeltaUnit::kMetres}),
              ElementsAre(Pair(3, 6), Pair(6, 9)));
}

TEST(SubTrajectories, ByMetresFromEveryPoseWithinTolerance) {
  RelativeOptions options{.delta = 2.05, .unit = DeltaUnit::kMetres, .all_pairs = true};
  EXPECT_THAT(sub_trajectories(straight(5, 1), options), ElementsAre(Pair(0, 2), Pair(1, 3), Pair(2, 4)));
  options.relative_tolerance = 0.01;
  EXPECT_THAT(sub_trajectories(straight(5, 1), options), ElementsAre());
}

TEST(SubTrajectories, ByMetresTakeTheFirstOfThoseAsNear) {
  RelativeOptions options{
      .delta = 0.375, .unit = DeltaUnit::kMetres, .all_pairs = true, .relative_tolerance = 0.5};
  EXPECT_THAT(sub_trajectories(straight(4, 0.25), options), ElementsAre(Pair(0, 1), Pair(1, 2), Pair(2, 3)));
  slam::Trajectory standing = straight(3, 0.375);
  standing.insert(standing.begin() + 1, standing[1]);  // two poses at the same place
  EXPECT_THAT(sub_trajectories(standing, options), ElementsAre(Pair(0, 1), Pair(1, 3), Pair(2, 3)));
}

TEST(SubTrajectories, ByMetresAgreeWithTryingEveryEnd) {
  slam::Trajectory poses = {at(0, moved(0, 0, 0))};
  for (uint64_t i = 1; i < 300; ++i) {
    const double step_m =
        random_index(random_bits(7, 0, i), 5) == 0 ? 0 : 1e-3 * random_index(random_bits(7, 1, i), 400);
    poses.push_back(at(static_cast<double>(i), moved(poses.back().T.translation().x() + step_m, 0, 0)));
  }
  const std::vector<double> path_m = travelled(poses);
  std::vector<std::pair<size_t, size_t>> expected;
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    size_t best = i + 1;
    for (size_t j = i + 1; j < poses.size(); ++j) {
      if (std::abs(path_m[j] - path_m[i] - 2) < std::abs(path_m[best] - path_m[i] - 2)) best = j;
    }
    if (std::abs(path_m[best] - path_m[i] - 2) <= 0.2) expected.emplace_back(i, best);
  }
  EXPECT_GT(expected.size(), 200u);
  EXPECT_EQ(sub_trajectories(poses, {.delta = 2, .unit = DeltaUnit::kMetres, .all_pairs = true}), expected);
}

TEST(SubTrajectories, ByAngleOneAfterTheOtherStartAtTheFirstPose) {
  const RelativeOptions degrees{.delta = 25, .unit = DeltaUnit::kDegrees};
  EXPECT_THAT(sub_trajectories(circle(36, 1), degrees).at(0), Pair(0, 3));  // 10 degrees a step
  EXPECT_EQ(sub_trajectories(circle(36, 1), degrees).size(), 11u);          // 35 steps, three each
  const RelativeOptions radians{.delta = 25 * kRadPerDeg, .unit = DeltaUnit::kRadians};
  EXPECT_EQ(sub_trajectories(circle(36, 1), radians), sub_trajectories(circle(36, 1), degrees));
}

TEST(SubTrajectories, ByAngleFromEveryPoseUseTheDirectAngle) {
  // Steps of 90 degrees: the pose three steps on is 90 degrees away again.
  const RelativeOptions degrees{.delta = 90, .unit = DeltaUnit::kDegrees, .all_pairs = true};
  EXPECT_THAT(sub_trajectories(circle(4, 1), degrees),
              ElementsAre(Pair(0, 1), Pair(0, 3), Pair(1, 2), Pair(2, 3)));
}

TEST(SubTrajectories, AreMeasuredOnTheEstimateOrTheReference) {
  PosePairs pairs{straight(11, 1), straight(11, 2)};
  RelativeOptions options{.delta = 4, .unit = DeltaUnit::kMetres};
  EXPECT_EQ(relative_errors(pairs, options).size(), 4u);
  options.pairs_from_reference = true;
  EXPECT_EQ(relative_errors(pairs, options).size(), 1u);
}

TEST(SubTrajectories, NeedAPositiveLength) {
  EXPECT_THROW(sub_trajectories(straight(3, 1), {.delta = 0}), std::invalid_argument);
  EXPECT_THROW(sub_trajectories(straight(3, 1), {.delta = 0.5}), std::invalid_argument);
  EXPECT_THROW(sub_trajectories(straight(3, 1), {.delta = -1, .unit = DeltaUnit::kMetres}),
               std::invalid_argument);
}

}  // namespace
}  // namespace groundloop::bench
