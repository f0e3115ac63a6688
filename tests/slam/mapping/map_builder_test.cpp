#include "slam/mapping/map_builder.h"

#include <gmock/gmock.h>

#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

using testing::ElementsAre;

constexpr int kLap = 24;

/// Looks of a lap through the laboratory, each from a place of its own.
std::vector<Look> looks_of_a_lap() {
  const RoomWorld world = RoomWorld::laboratory();
  std::vector<Look> looks;
  for (const Pose& T_map_left : laboratory_lap(kLap)) {
    const auto k = static_cast<int>(looks.size());
    std::vector<MapObservation> observations;
    for (const MapPoint& point : measure(world, laboratory_rig(), T_map_left, 300, 0.1, k)) {
      const Eigen::Vector3d uvu = laboratory_rig().project(T_map_left.inverse() * point.p_map);
      observations.push_back({uvu.cast<float>(), 1});
    }
    looks.push_back(
        {k, k, Pose::Identity(), std::make_shared<const std::vector<MapObservation>>(observations), {}});
  }
  return looks;
}

OccupancyMap drawn_at_once(const std::vector<Look>& looks, const std::vector<Pose>& T_map_place) {
  Mapper mapper(laboratory_rig(), {});
  for (const Look& look : looks) mapper.add(T_map_place[look.place] * look.T_place_left, *look.observations);
  return mapper.grid().map();
}

Pose shifted(double x_m, double yaw_rad) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp({0, 0, yaw_rad});
  T.translation().x() = x_m;
  return T;
}

class MapBuilderTest : public testing::Test {
 protected:
  void add_all(MapBuilder& builder) const {
    for (const Look& look : looks_) builder.add(look, places_);
  }
  std::vector<Look> looks_ = looks_of_a_lap();
  std::vector<Pose> places_ = laboratory_lap(kLap);
};

TEST_F(MapBuilderTest, AddingLooksIsDrawingThemOneAfterAnother) {
  MapBuilder builder(laboratory_rig(), {}, 8);
  add_all(builder);
  EXPECT_EQ(builder.grid().map().value, drawn_at_once(looks_, places_).value);
  EXPECT_EQ(builder.looks().size(), looks_.size());
}

TEST_F(MapBuilderTest, WhatIsKeptIsDrawnWhenAskedAFewLooksACall) {
  MapBuilder builder(laboratory_rig(), {}, 8);
  for (const Look& look : looks_) builder.keep(look);
  EXPECT_TRUE(builder.grid().map().value.empty());
  int calls = 1;
  while (!builder.draw(places_, 5)) ++calls;
  EXPECT_EQ(calls, 5) << "24 looks, 5 a call";
  EXPECT_EQ(builder.grid().map().value, drawn_at_once(looks_, places_).value);
}

TEST_F(MapBuilderTest, APlaceForgetsLooksThatWereNeverDrawn) {
  MapBuilder builder(laboratory_rig(), {}, 2);
  for (Look look : looks_) {
    look.T_place_left = places_[0].inverse() * places_[look.place];
    look.place = 0;
    builder.keep(look);
  }
  ASSERT_EQ(builder.looks().size(), 2U);
  EXPECT_TRUE(builder.draw(places_, 5));
  EXPECT_EQ(builder.grid().map().value, drawn_at_once(builder.looks(), places_).value);
}

TEST_F(MapBuilderTest, FollowsPlacesThatMoveAFewLooksACall) {
  MapBuilder builder(laboratory_rig(), {}, 8);
  add_all(builder);
  for (size_t i = kLap / 2; i < kLap; ++i) places_[i] = shifted(0.15, 0.02) * places_[i];
  std::vector<Look> seen = looks_;
  for (int call = 0; call < 8; ++call) {
    Look look = looks_[0];
    look.key_frame = kLap + call;
    look.place = call;
    seen.push_back(look);
    builder.add(look, places_);
  }
  EXPECT_EQ(builder.grid().map().value, drawn_at_once(seen, places_).value);
}

TEST_F(MapBuilderTest, StaysAsItIsWhenPlacesHardlyMove) {
  MapBuilder builder(laboratory_rig(), {}, 8);
  add_all(builder);
  const std::vector<Pose> before = places_;
  for (Pose& place : places_) place = shifted(0.01, 0) * place;  // less than half a cell
  builder.add(looks_[0], places_);
  MapBuilder other(laboratory_rig(), {}, 8);
  for (const Look& look : looks_) other.add(look, before);
  other.add(looks_[0], places_);
  EXPECT_EQ(builder.grid().map().value, other.grid().map().value);
}

TEST_F(MapBuilderTest, CompletingDrawsAllWhereItIsNow) {
  MapBuilder builder(laboratory_rig(), {}, 8);
  add_all(builder);
  for (Pose& place : places_) place = shifted(0.01, 0.001) * place;
  for (const bool by_two : {false, true}) {
    builder.complete(places_, by_two);
    EXPECT_EQ(builder.grid().map().value, drawn_at_once(looks_, places_).value);
  }
}

TEST_F(MapBuilderTest, APlaceKeepsItsNewestLooks) {
  MapBuilder builder(laboratory_rig(), {}, 2);
  for (int k = 0; k < 6; ++k) {
    Look look = looks_[k];
    look.place = k % 2;
    look.T_place_left = places_[k % 2].inverse() * places_[k];
    builder.add(look, places_);
  }
  std::vector<int> kept;
  for (const Look& look : builder.looks()) kept.push_back(look.key_frame);
  EXPECT_THAT(kept, ElementsAre(2, 3, 4, 5));
  builder.complete(places_, true);
  EXPECT_EQ(builder.grid().map().value, drawn_at_once(builder.looks(), places_).value)
      << "what was forgotten is in the map no more";
}

}  // namespace
}  // namespace groundloop::slam
