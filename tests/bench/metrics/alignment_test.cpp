#include "bench/metrics/alignment.h"

#include <gtest/gtest.h>

#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

const slam::Pose kT = moved(3, -1, 2) * turned(130, {0.3, -1, 0.5});

Eigen::Matrix3Xd cloud() {
  Eigen::Matrix3Xd p(3, 6);
  p << 0, 1, 2, 0, -1, 4,  //
      0, 2, 1, 3, 5, -2,   //
      1, 0, 2, 2, -3, 1;
  return p;
}

Eigen::Matrix3Xd transformed(const slam::Pose& T, double scale, const Eigen::Matrix3Xd& p) {
  return (scale * T.linear() * p).colwise() + T.translation();
}

TEST(AlignPoints, RecoversARigidMotion) {
  const Alignment found = align_points(transformed(kT, 1, cloud()), cloud(), false);
  EXPECT_TRUE(found.T_truth_map.isApprox(kT, 1e-13));
  EXPECT_EQ(found.scale, 1);
  EXPECT_TRUE(found.unique);
}

TEST(AlignPoints, RecoversScale) {
  const Alignment found = align_points(transformed(kT, 2.5, cloud()), cloud(), true);
  EXPECT_TRUE(found.T_truth_map.isApprox(kT, 1e-13));
  EXPECT_NEAR(found.scale, 2.5, 1e-13);
}

TEST(AlignPoints, NeverReflects) {
  Eigen::Matrix3Xd mirrored = cloud();
  mirrored.row(2) *= -1;
  EXPECT_NEAR(align_points(mirrored, cloud(), true).T_truth_map.linear().determinant(), 1, 1e-12);
}

TEST(AlignPoints, OfAPlaneIsUnique) {
  Eigen::Matrix3Xd plane = cloud();
  plane.row(2).setZero();
  const Alignment found = align_points(transformed(kT, 1, plane), plane, false);
  EXPECT_TRUE(found.unique);
  EXPECT_TRUE(found.T_truth_map.isApprox(kT, 1e-12));
}

TEST(AlignPoints, OfALineSaysThatARotationIsOpenYetFits) {
  Eigen::Matrix3Xd line = cloud();
  line.bottomRows(2).setZero();
  const Eigen::Matrix3Xd target = transformed(kT, 1, line);
  const Alignment found = align_points(target, line, false);
  EXPECT_FALSE(found.unique);
  EXPECT_LT((transformed(found.T_truth_map, 1, line) - target).norm(), 1e-12);
}

TEST(AlignPoints, OfOnePointKeepsTheScale) {
  const Alignment found = align_points(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 4, 4), true);
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT((found.T_truth_map * Eigen::Vector3d(4, 4, 4) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-14);
}

/// Estimate of a circle in a map frame of its own, with every length too short by the factor `scale`.
PosePairs circle_pairs(double scale) {
  PosePairs pairs{circle(12, 2), circle(12, 2)};
  for (auto& pose : pairs.estimate) {
    pose.T = kT.inverse() * pose.T;
    pose.T.translation() /= scale;
  }
  return pairs;
}

double largest_difference(const PosePairs& pairs) {
  double largest = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    largest = std::max(largest, (pairs.truth[i].T.matrix() - pairs.estimate[i].T.matrix()).norm());
  }
  return largest;
}

TEST(Align, Se3LaysPosesOnTheTruth) {
  PosePairs pairs = circle_pairs(1);
  EXPECT_TRUE(align(pairs, AlignMode::kSe3).T_truth_map.isApprox(kT, 1e-12));
  EXPECT_LT(largest_difference(pairs), 1e-12);
}

TEST(Align, Sim3AlsoUndoesTheScale) {
  PosePairs pairs = circle_pairs(1.25);
  EXPECT_NEAR(align(pairs, AlignMode::kSim3).scale, 1.25, 1e-12);
  EXPECT_LT(largest_difference(pairs), 1e-12);
}

TEST(Align, ScaleAloneLeavesThePosesWhereTheyAre) {
  PosePairs pairs = circle_pairs(1.25);
  const Eigen::Vector3d before = pairs.estimate[3].T.translation();
  const Alignment applied = align(pairs, AlignMode::kScale);
  EXPECT_NEAR(applied.scale, 1.25, 1e-12);
  EXPECT_TRUE(applied.T_truth_map.isApprox(slam::Pose::Identity()));
  EXPECT_LT((pairs.estimate[3].T.translation() - 1.25 * before).norm(), 1e-12);
}

TEST(Align, OriginLaysOnlyTheFirstPose) {
  PosePairs pairs = circle_pairs(2);
  align(pairs, AlignMode::kOrigin);
  EXPECT_LT((pairs.truth[0].T.matrix() - pairs.estimate[0].T.matrix()).norm(), 1e-12);
  EXPECT_GT((pairs.truth[6].T.translation() - pairs.estimate[6].T.translation()).norm(), 1);
}

TEST(Align, ByTheFirstPosesIgnoresLaterErrors) {
  PosePairs pairs = circle_pairs(1);
  pairs.estimate[11].T = moved(100, 0, 0) * pairs.estimate[11].T;
  EXPECT_TRUE(align(pairs, AlignMode::kSe3, 6).T_truth_map.isApprox(kT, 1e-12));
}

TEST(Align, NoneChangesNothing) {
  PosePairs pairs = circle_pairs(1);
  const slam::Pose before = pairs.estimate[5].T;
  align(pairs, AlignMode::kNone);
  EXPECT_TRUE(pairs.estimate[5].T.isApprox(before, 0));
}

TEST(MapPlacement, OfACurvedPathIsTheAlignment) {
  PosePairs pairs = circle_pairs(1);
  pairs.estimate[4].T = moved(0.1, 0.02, 0) * pairs.estimate[4].T;
  const slam::Pose placement = map_placement(pairs);
  EXPECT_TRUE(placement.isApprox(align(pairs, AlignMode::kSe3).T_truth_map, 0));
}

TEST(MapPlacement, OfAStraightPathIsDecidedByTheOrientations) {
  PosePairs pairs;
  for (int i = 0; i < 20; ++i) {
    const slam::Pose T_world_left = kT * moved(0.1 * i, 0, 0) * turned(20, {0, 0, 1});
    const double side_m = i % 2 == 0 ? 1e-5 : -1e-5;  // nothing that positions could tell a rotation by
    pairs.truth.push_back({i, T_world_left});
    pairs.estimate.push_back({i, moved(0, side_m, 0) * moved(1, 2, 3) * T_world_left});
  }
  EXPECT_LT(slam::se3_log(map_placement(pairs) * moved(1, 2, 3)).norm(), 1e-4);
}

TEST(MapPlacement, OfOnePoseLaysThatPose) {
  PosePairs pairs;
  pairs.truth.push_back({0, kT});
  pairs.estimate.push_back({0, turned(70, {0, 1, 0}) * moved(1, 0, 0)});
  EXPECT_TRUE(map_placement(pairs).isApprox(kT * pairs.estimate[0].T.inverse(), 1e-12));
}

}  // namespace
}  // namespace groundloop::bench
