#include "bench/runner/slam_options.h"

#include <gtest/gtest.h>

#include <cmath>

namespace groundloop::bench {
namespace {

sim::Scenario scenario_with(double slam_scale, double scale) {
  sim::Scenario scenario;
  scenario.slam.scale = slam_scale;
  scenario.scale = scale;
  return scenario;
}

TEST(SlamOptions, LengthsFollowTheScaleAndNothingElseDoes) {
  const slam::SlamOptions room = slam::preset("default");
  const slam::SlamOptions model = slam_options(scenario_with(0.25, 1));
  EXPECT_DOUBLE_EQ(model.mapping.cell_m, 0.25 * room.mapping.cell_m);
  EXPECT_DOUBLE_EQ(model.mapping.max_range_m, 0.25 * room.mapping.max_range_m);
  EXPECT_DOUBLE_EQ(model.loop.margin_m, 0.25 * room.loop.margin_m);
  ASSERT_EQ(model.mapping.layer_heights_m.size(), room.mapping.layer_heights_m.size());
  for (size_t i = 0; i < room.mapping.layer_heights_m.size(); ++i) {
    EXPECT_DOUBLE_EQ(model.mapping.layer_heights_m[i], 0.25 * room.mapping.layer_heights_m[i]);
  }
  EXPECT_EQ(model.loop.margin_deg, room.loop.margin_deg);
  EXPECT_EQ(model.registration.sigma_px, room.registration.sigma_px);
  EXPECT_EQ(model.key_frame.max_translation_ratio, room.key_frame.max_translation_ratio);
}

TEST(SlamOptions, OptionsThatAreSetAreInTheScenariosOwnMetres) {
  sim::Scenario scenario = scenario_with(0.25, 1);
  scenario.slam.set["mapping.cell_m"] = "0.02";
  EXPECT_DOUBLE_EQ(slam_options(scenario).mapping.cell_m, 0.02);
  scenario.scale = 4;  // now all of the scenario is larger
  EXPECT_DOUBLE_EQ(slam_options(scenario).mapping.cell_m, 0.08);
}

TEST(SlamOptions, AnArmsRepeatabilityIsToldOfTwoStopsInTheScenariosOwnMetres) {
  sim::Scenario scenario = scenario_with(0.25, 1);
  EXPECT_EQ(slam_options(scenario).adjustment.pair_sigma_m, 0);
  scenario.robot.arm.repeatability_m = 3e-5;
  scenario.robot.arm.repeatability_deg = 0.002;
  EXPECT_DOUBLE_EQ(slam_options(scenario).adjustment.pair_sigma_m, std::sqrt(2.0) * 3e-5);
  EXPECT_DOUBLE_EQ(slam_options(scenario).adjustment.pair_sigma_deg, std::sqrt(2.0) * 0.002);
  scenario.slam.set["adjustment.pair_sigma_m"] = "1e-4";
  EXPECT_DOUBLE_EQ(slam_options(scenario).adjustment.pair_sigma_m, 1e-4) << "who knows better, says so";
}

TEST(SlamOptions, AModelOfARoomMadeAsLargeAsTheRoomIsTheRoom) {
  EXPECT_EQ(to_yaml(slam_options(scenario_with(0.25, 4))), to_yaml(slam_options(scenario_with(1, 1))));
}

}  // namespace
}  // namespace groundloop::bench
