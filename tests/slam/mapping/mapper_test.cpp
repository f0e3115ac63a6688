#include "slam/mapping/mapper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

TEST(MapObservation, KeepsAMeasurementInEightBytes) {
  const MapObservation o({413.27F, 100.91F, 401.13F}, 0.5F, 0.13F);
  EXPECT_NEAR(o.uvu_px().x(), 413.27, 0.5 / 32 + 1e-4);
  EXPECT_NEAR(o.uvu_px().y(), 100.91, 0.5 / 32 + 1e-4);
  EXPECT_NEAR(o.uvu_px().x() - o.uvu_px().z(), 12.14, 0.5 / 64 + 1e-4);
  EXPECT_NEAR(o.weight(), 0.5, 0.5 / 255 + 1e-6);
  EXPECT_NEAR(o.sigma_px(), 0.13, 0.5 / 128 + 1e-6);
  EXPECT_EQ(MapObservation({1, 2, 3}, 1).sigma_px(), 0) << "that of the options";
  EXPECT_LT(MapObservation({1, 2, 3}, 1).uvu_px().x() - MapObservation({1, 2, 3}, 1).uvu_px().z(), 0)
      << "toed-in heads have negative disparities";
  const MapObservation beyond({3000, -5, 1}, 7, 9);
  EXPECT_NEAR(beyond.uvu_px().x(), 2048, 0.1);
  EXPECT_EQ(beyond.uvu_px().y(), 0);
  EXPECT_EQ(beyond.weight(), 1);
}

/// What a level head at the origin sees of a floor and of upright boards across its way.
class View {
 public:
  View() { T_map_left = StereoRig::level_camera({0, 0, kHeight_m}); }

  void floor() {
    for (double x = 0.7; x < 4; x += 0.05) {
      for (double y = -1.5; y < 1.5; y += 0.02) seen_map_.emplace_back(x, y, 0);
    }
  }
  /// A board that stands on the floor, x ahead and from y to y + width; it hides what lies behind it.
  void board(double x_m, double y_m, double width_m, double top_m) {
    std::erase_if(seen_map_, [&](const Eigen::Vector3d& p) {
      const double part = x_m / p.x(), y = p.y() * part, z = kHeight_m + (p.z() - kHeight_m) * part;
      return part < 1 && y > y_m && y < y_m + width_m && z < top_m;
    });
    for (double y = y_m; y < y_m + width_m; y += 0.02) {
      for (double z = 0.1; z < top_m; z += 0.05) seen_map_.emplace_back(x_m, y, z);
    }
  }
  std::vector<MapObservation> observations() const {
    std::vector<MapObservation> observations;
    for (const Eigen::Vector3d& p_map : seen_map_) {
      const Eigen::Vector3d uvu = rig.project(T_map_left.inverse() * p_map);
      const bool in_image = uvu.x() < rig.width_px && uvu.z() > 0 && uvu.y() > 0 && uvu.y() < rig.height_px;
      if (in_image) observations.push_back({uvu.cast<float>(), 1, 0.1F});
    }
    return observations;
  }

  StereoRig rig = laboratory_rig();
  Pose T_map_left;

 private:
  static constexpr double kHeight_m = 0.35;
  std::vector<Eigen::Vector3d> seen_map_;
};

enum class Call { kFree, kUnknown, kOccupied };
Call call(const Mapper& mapper, double x_m, double y_m) {
  const float value = mapper.grid().map().at_point(x_m, y_m);
  return value > OccupancyMap::kOccupiedAbove ? Call::kOccupied
         : value < OccupancyMap::kFreeBelow   ? Call::kFree
                                              : Call::kUnknown;
}

TEST(Mapper, APersonWhoLeftFadesAndTheWallBehindAppears) {
  View empty, with_person;
  empty.floor(), with_person.floor();
  empty.board(4.02, -1.5, 3, 2.5);
  with_person.board(4.02, -1.5, 3, 2.5);
  with_person.board(2.02, -0.25, 0.5, 1.8);
  Mapper mapper(empty.rig, FlogOptions{});
  for (int i = 0; i < 10; ++i) mapper.add(with_person.T_map_left, with_person.observations());
  EXPECT_EQ(call(mapper, 2.02, 0.01), Call::kOccupied);
  EXPECT_EQ(call(mapper, 4.02, 0.01), Call::kUnknown) << "hidden behind the person";
  EXPECT_EQ(call(mapper, 4.02, 1.21), Call::kOccupied);
  for (int i = 0; i < 5; ++i) mapper.add(empty.T_map_left, empty.observations());
  for (double y = -0.3; y < 0.3; y += 0.05) {
    EXPECT_EQ(call(mapper, 2.02, y), Call::kFree) << y;
    EXPECT_EQ(call(mapper, 4.02, y), Call::kOccupied) << y;
  }
  EXPECT_EQ(call(mapper, 4.02, 1.21), Call::kOccupied) << "what stayed, stays";
}

TEST(Mapper, AChairThatWasMovedIsWhereItIsNow) {
  View before, after;
  before.floor(), after.floor();
  before.board(4.02, -1.5, 3, 2.5), before.board(2.02, -0.6, 0.4, 0.9);
  after.board(4.02, -1.5, 3, 2.5), after.board(2.02, 0.3, 0.4, 0.9);
  Mapper mapper(before.rig, FlogOptions{});
  for (int i = 0; i < 10; ++i) mapper.add(before.T_map_left, before.observations());
  EXPECT_EQ(call(mapper, 2.02, -0.39), Call::kOccupied);
  EXPECT_EQ(call(mapper, 2.02, 0.51), Call::kFree);
  for (int i = 0; i < 5; ++i) mapper.add(after.T_map_left, after.observations());
  EXPECT_EQ(call(mapper, 2.02, -0.39), Call::kFree);
  EXPECT_EQ(call(mapper, 2.02, 0.51), Call::kOccupied);
}

TEST(Mapper, AMapBuiltAgainIsTheSameToTheBit) {
  View view;
  view.board(3.02, -1, 2, 2);
  Mapper first(view.rig, FlogOptions{}), again(view.rig, FlogOptions{});
  Pose T_map_left = view.T_map_left;
  for (int i = 0; i < 6; ++i) {
    T_map_left.translation().x() += 0.07;
    first.add(T_map_left, view.observations());
  }
  T_map_left = view.T_map_left;
  for (int i = 0; i < 6; ++i) {
    T_map_left.translation().x() += 0.07;
    again.add(T_map_left, view.observations());
  }
  EXPECT_EQ(first.grid().map().value, again.grid().map().value);
}

TEST(Mapper, AMirroredThingInTheFloorAndTheCeilingDoNotEnter) {
  View view;
  Mapper mapper(view.rig, FlogOptions{});
  std::vector<MapObservation> observations;
  for (double y = -0.5; y < 0.5; y += 0.02) {
    for (const double z : {-1.0, -0.4, -0.05, 0.0, 2.1, 2.9}) {
      const Eigen::Vector3d uvu = view.rig.project(view.T_map_left.inverse() * Eigen::Vector3d(6, y, z));
      observations.push_back({uvu.cast<float>(), 1, 0.1F});
    }
  }
  for (int i = 0; i < 5; ++i) mapper.add(view.T_map_left, observations);
  for (const OccupancyMap& layer : mapper.grid().layers()) {
    for (const float value : layer.value) EXPECT_LE(value, OccupancyMap::kUnknown);
  }
  EXPECT_EQ(call(mapper, 0.5, 0.01), Call::kFree);
}

}  // namespace
}  // namespace groundloop::slam
