#include "slam/loop/place_map.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr int kSide = 8;         // key frames along one side of the square that is driven
constexpr int kLap = 4 * kSide;  // key frame kLap stands where key frame 0 stood
constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;

Matrix6d covariance_of(double sigma_m, double sigma_rad) {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variance.asDiagonal();
}

const Matrix6d kSeen = covariance_of(0.001, 0.0005);

double distance_m(const Pose& a, const Pose& b) { return (a.inverse() * b).translation().norm(); }

/// Laps around a square of 4 m, half a metre a key frame, and what odometry makes of them.
class Laps {
 public:
  /// @param drift  of the heading, a key frame
  explicit Laps(double drift_rad) {
    Pose T = Pose::Identity();
    Pose T_odom = T;
    for (int k = 0; k <= 2 * kLap; ++k) {
      truth.push_back(T);
      odometry.push_back({k, T_odom, k == 0 ? Matrix6d::Zero().eval() : covariance_of(kSigma_m, kSigma_rad)});
      Pose step = Pose::Identity();
      step.translation().x() = 0.5;
      if (k % kSide == kSide - 1) step.linear() = so3_exp({0, 0, std::numbers::pi / 2});
      T = T * step;
      step.linear() = step.linear() * so3_exp({0, 0, drift_rad});
      T_odom = T_odom * step;
    }
  }

  Tie seen(int place, int place_key_frame, int key_frame) const {
    return {place, key_frame, truth[place_key_frame].inverse() * truth[key_frame], kSeen};
  }

  std::vector<Pose> truth;
  std::vector<OdometryPose> odometry;
};

/// A map of the first key frames, each a place.
PlaceMap map_of(const Laps& laps, int key_frames) {
  PlaceMap map;
  for (int k = 0; k < key_frames; ++k) {
    map.advance(laps.odometry[k], {});
    if (k == 0) {
      map.start(Pose::Identity());
    } else {
      map.add_place();
    }
  }
  return map;
}

double worst_m(const PlaceMap& map, const Laps& laps, int key_frames) {
  double worst = 0;
  for (int k = 0; k < key_frames; ++k) worst = std::max(worst, distance_m(map.T_map_left(k), laps.truth[k]));
  return worst;
}

TEST(PlaceMap, FollowsOdometryUntilAPlaceIsRecognised) {
  const Laps laps(0.003);
  PlaceMap map = map_of(laps, kLap);
  EXPECT_EQ(map.places(), kLap);
  for (int k = 0; k < kLap; ++k) {
    EXPECT_LT(distance_m(map.T_map_left(k), laps.odometry[k].T_odom_left), 1e-12);
    EXPECT_EQ(map.standing(k).place, k);
  }
  EXPECT_GT(worst_m(map, laps, kLap), 0.2) << "nothing to correct";
}

TEST(PlaceMap, ARecognisedPlaceTakesTheGatheredErrorBackAlongThePath) {
  const Laps laps(0.003);
  PlaceMap map = map_of(laps, kLap);
  const double before_m = worst_m(map, laps, kLap);
  map.advance(laps.odometry[kLap], {});
  ASSERT_TRUE(map.recognise(laps.seen(0, 0, kLap), false));
  EXPECT_EQ(map.places(), kLap) << "a known place is not made twice";
  EXPECT_EQ(map.standing(kLap).place, 0);
  EXPECT_LT(distance_m(map.T_map_left(kLap), laps.truth[kLap]), 0.002);
  EXPECT_LT(worst_m(map, laps, kLap), 0.3 * before_m);
  // The ties say the same as the key frames that hang on them.
  const std::vector<Pose> T_map_odom = map.T_map_odom();
  EXPECT_LT(distance_m(T_map_odom[map.tie()] * laps.odometry[kLap].T_odom_left, map.T_map_left(kLap)), 1e-9);
}

TEST(PlaceMap, AKnownAreaGetsNoSecondSetOfPlaces) {
  const Laps laps(0.003);
  PlaceMap map = map_of(laps, kLap);
  for (int k = kLap; k < 2 * kLap; ++k) {
    map.advance(laps.odometry[k], {});
    ASSERT_TRUE(map.recognise(laps.seen(k - kLap, k - kLap, k), false)) << k;
  }
  EXPECT_EQ(map.places(), kLap);
  EXPECT_LT(worst_m(map, laps, 2 * kLap), 0.05);
}

TEST(PlaceMap, OdometryGoesOnFromWhereARecognisedKeyFrameStands) {
  const Laps laps(0.003);
  PlaceMap map = map_of(laps, kLap);
  map.advance(laps.odometry[kLap], {});
  ASSERT_TRUE(map.recognise(laps.seen(0, 0, kLap), false));
  map.advance(laps.odometry[kLap + 1], {});
  const Pose step = laps.odometry[kLap].T_odom_left.inverse() * laps.odometry[kLap + 1].T_odom_left;
  EXPECT_LT(distance_m(map.T_map_left(kLap + 1), map.T_map_left(kLap) * step), 1e-9);
  EXPECT_EQ(map.standing(kLap + 1).place, 0);
}

TEST(PlaceMap, RefusesWhatTheRestOfTheMapContradicts) {
  const Laps laps(0);
  PlaceMap map = map_of(laps, kLap);
  const std::vector<Pose> before = map.T_map_place();
  map.advance(laps.odometry[kLap], {});
  Tie wrong = laps.seen(0, 0, kLap);
  wrong.T_place_left.translation().y() += 1.5;  // odometry is sure to some 0.1 m
  EXPECT_FALSE(map.recognise(wrong, false));
  for (int i = 0; i < map.places(); ++i) EXPECT_LT(distance_m(map.T_map_place()[i], before[i]), 1e-12);
  EXPECT_EQ(map.standing(kLap).place, kLap - 1);
  EXPECT_TRUE(map.recognise(laps.seen(0, 0, kLap), false)) << "the right one is still welcome";
}

TEST(PlaceMap, PartsAreJoinedByARecognitionAndTheYoungerMoves) {
  const Laps laps(0);
  PlaceMap map = map_of(laps, 4);
  // Track is lost: what follows is somewhere else, as far as the map knows.
  Pose T_believed = Pose::Identity();
  T_believed.translation() << 7, -3, 0;
  std::vector<OdometryPose> lost(laps.odometry.begin() + 4, laps.odometry.begin() + 8);
  map.advance(lost[0], {});
  map.start(T_believed);
  for (int k = 1; k < 3; ++k) {
    map.advance(lost[k], {});
    map.add_place();
  }
  EXPECT_FALSE(map.relative(1, 5)) << "nothing connects the two";
  const Pose older = map.T_map_left(2);
  map.advance(lost[3], {});
  ASSERT_TRUE(map.recognise(laps.seen(2, 2, 7), false));
  EXPECT_LT(distance_m(map.T_map_left(2), older), 1e-12);
  for (int k = 4; k < 8; ++k) EXPECT_LT(distance_m(map.T_map_left(k), laps.truth[k]), 1e-3) << k;
  ASSERT_TRUE(map.relative(1, 5));
  EXPECT_LT(distance_m(map.relative(1, 5)->T_from_to, laps.truth[1].inverse() * laps.truth[5]), 1e-3);
}

TEST(PlaceMap, UncertaintyGrowsAlongThePathAndShrinksByARecognition) {
  const Laps laps(0);
  PlaceMap map = map_of(laps, kLap);
  const auto sigma_m = [&](int from, int to) {
    return std::sqrt(map.relative(from, to)->covariance.topLeftCorner<3, 3>().trace());
  };
  // One step: what was said of it.
  EXPECT_NEAR(sigma_m(4, 5), std::sqrt(3.0) * kSigma_m, 1e-9);
  EXPECT_GT(sigma_m(0, 20), sigma_m(0, 10));
  const double open = sigma_m(0, kLap - 1);
  map.advance(laps.odometry[kLap], {});
  ASSERT_TRUE(map.recognise(laps.seen(0, 0, kLap), false));
  EXPECT_LT(sigma_m(0, kLap), 0.002);
  EXPECT_LT(sigma_m(0, kLap - 1), 0.3 * open) << "the short way is the one that counts";
}

TEST(PlaceMap, TakesOverRefinedOdometry) {
  const Laps rough(0.003), better(0);
  PlaceMap map = map_of(rough, 6);
  const std::vector<OdometryPose> refined(better.odometry.begin(), better.odometry.begin() + 6);
  map.refine(refined);
  for (int k = 0; k < 6; ++k) EXPECT_LT(distance_m(map.T_map_left(k), better.truth[k]), 1e-9) << k;
}

}  // namespace
}  // namespace groundloop::slam
