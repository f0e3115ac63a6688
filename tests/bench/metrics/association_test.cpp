#include "bench/metrics/association.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/metrics/poses.h"

namespace groundloop::bench {
namespace {

using testing::ElementsAre;

/// Poses at these times [s]; x tells them apart.
slam::Trajectory at_times(const std::vector<double>& times_s) {
  slam::Trajectory poses;
  for (size_t i = 0; i < times_s.size(); ++i)
    poses.push_back(at(times_s[i], moved(static_cast<double>(i), 0, 0)));
  return poses;
}

std::vector<int> indices(const slam::Trajectory& poses) {
  std::vector<int> result;
  for (const auto& pose : poses) result.push_back(static_cast<int>(pose.T.translation().x()));
  return result;
}

TEST(Association, PairsTheNearestOfTheLongerOne) {
  const PosePairs pairs = associate_by_time(at_times({0, 0.02, 0.04, 0.06}), at_times({0.021, 0.059}));
  EXPECT_THAT(indices(pairs.truth), ElementsAre(1, 3));
  EXPECT_THAT(indices(pairs.estimate), ElementsAre(0, 1));
}

TEST(Association, WorksTheSameWhenTheEstimateIsLonger) {
  const PosePairs pairs = associate_by_time(at_times({0.021, 0.059}), at_times({0, 0.02, 0.04, 0.06}));
  EXPECT_THAT(indices(pairs.truth), ElementsAre(0, 1));
  EXPECT_THAT(indices(pairs.estimate), ElementsAre(1, 3));
}

TEST(Association, LeavesOutStampsTooFarApart) {
  const PosePairs pairs = associate_by_time(at_times({0, 1, 2}), at_times({0.009, 1.02}));
  EXPECT_THAT(indices(pairs.truth), ElementsAre(0));
  EXPECT_EQ(
      associate_by_time(at_times({0, 1, 2}), at_times({0.009, 1.02}), {.max_difference_s = 0.05}).size(), 2u);
}

TEST(Association, OffsetIsAddedToTheEstimate) {
  const AssociationOptions later{.max_difference_s = 0.01, .offset_s = 0.5};
  EXPECT_THAT(indices(associate_by_time(at_times({0, 0.5, 1}), at_times({0, 0.5}), later).truth),
              ElementsAre(1, 2));
  EXPECT_THAT(indices(associate_by_time(at_times({0.5}), at_times({0, 0.5}), later).estimate),
              ElementsAre(0));
}

TEST(Association, OfTwoAsNearTakesTheEarlier) {
  const AssociationOptions wide{.max_difference_s = 1, .offset_s = 0};
  EXPECT_THAT(indices(associate_by_time(at_times({0, 1, 2}), at_times({0.5, 1.5}), wide).truth),
              ElementsAre(0, 1));
  EXPECT_THAT(indices(associate_by_time(at_times({1, 1, 3}), at_times({1.25}), wide).truth), ElementsAre(0));
}

TEST(Association, APoseOfTheLongerOneMayServeTwice) {
  const PosePairs pairs = associate_by_time(at_times({0, 10, 20}), at_times({9.995, 10.005}));
  EXPECT_THAT(indices(pairs.truth), ElementsAre(1, 1));
}

TEST(Association, OfNothingIsNothing) {
  EXPECT_EQ(associate_by_time({}, at_times({0})).size(), 0u);
  EXPECT_EQ(associate_by_time(at_times({0}), {}).size(), 0u);
}

}  // namespace
}  // namespace groundloop::bench
