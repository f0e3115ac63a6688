#include "sim/generate/route.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/generate/realize.h"
#include "sim/simulation/simulation.h"
#include "tests/sim/generate/recipes.h"

namespace groundloop::sim {
namespace {

using ::testing::HasSubstr;

std::string lab() { return std::filesystem::absolute("models/worlds/lab.xml").string(); }

/// One for all tests: pictures are read once.
PictureContrast& pictures() {
  static PictureContrast pictures;
  return pictures;
}

Scenario made(const std::string& world, const std::string& plan) {
  return realized(scenario_with(world, plan), pictures());
}

std::string message(const std::string& world, const std::string& plan) {
  try {
    made(world, plan);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Route, LeadsThroughAHandMadeWorldToo) {
  const Scenario scenario = made(lab(), "{speed_mps: 0.3, generate: {seed: 2, length_m: 25, laps: 2}}");
  EXPECT_FALSE(scenario.plan.generate.has_value());
  const World world = World::load(scenario, Looks::kNone);
  const Simulation simulation(world, load_head(scenario.head.model), scenario);  // checks the path
  EXPECT_NEAR(simulation.planned_length_m(), 25, 0.5 * 25);
  const slam::Pose start = simulation.planned_T_world_body(0);
  const slam::Pose end = simulation.planned_T_world_body(simulation.planned_duration_s());
  EXPECT_LT((start.inverse() * end).translation().norm(), 1e-6);
}

TEST(Route, SecondLapIsTheFirstAgain) {
  const Scenario one = made(lab(), "{speed_mps: 0.3, generate: {seed: 3, length_m: 12, laps: 1}}");
  const Scenario two = made(lab(), "{speed_mps: 0.3, generate: {seed: 3, length_m: 24, laps: 2}}");
  const auto& a = one.plan.segments;
  const auto& b = two.plan.segments;
  // the last straight of the first lap and the first of the second are one
  ASSERT_EQ(b.size(), 2 * a.size() - 1);
  for (size_t i = 1; i + 1 < a.size(); ++i) {
    ASSERT_EQ(a[i].arc.has_value(), b[i].arc.has_value()) << i;
    const size_t again = a.size() - 1 + i;
    if (a[i].arc) {
      EXPECT_EQ(a[i].arc->radius_m, b[again].arc->radius_m);
      EXPECT_EQ(a[i].arc->angle_deg, b[again].arc->angle_deg);
    } else {
      EXPECT_EQ(a[i].straight_m, b[again].straight_m);
    }
  }
  EXPECT_NEAR(*b[a.size() - 1].straight_m, *a.front().straight_m + *a.back().straight_m, 1e-12);
}

TEST(Route, RepeatsAndDiffersWithTheSeed) {
  const auto yaml = [](int seed) {
    return to_yaml(made(lab(), fmt::format("{{speed_mps: 0.3, generate: {{seed: {}}}}}", seed)));
  };
  EXPECT_EQ(yaml(1), yaml(1));
  EXPECT_NE(yaml(1), yaml(2));
}

TEST(Route, SavedScenarioIsTheSameRunWithoutAGenerator) {
  const Scenario drawn = made("{generate: {seed: 6, style: clutter, textures: " + textures() + "}}",
                                               "{speed_mps: 0.3, generate: {length_m: 10}}");
  const std::string text = to_yaml(drawn);
  const auto file = std::filesystem::temp_directory_path() / "saved.yaml";
  std::ofstream(file) << text;
  const Scenario again = realized(load_scenario(file.string()));
  EXPECT_EQ(to_yaml(again), text);
  EXPECT_EQ(generated_text(again), generated_text(drawn));
}

TEST(Route, WhatCannotBeIsSaid) {
  EXPECT_THAT(message(lab(), "{speed_mps: 0.3, generate: {min_radius_m: 9}}"),
              HasSubstr("plan.generate: no way in "));
  EXPECT_THAT(message(lab(), "{speed_mps: 0.3, generate: {min_texture: 1}}"),
              HasSubstr("or a smaller length_m, min_radius_m, clearance_m or min_texture"));
  EXPECT_THAT(message(lab(), "{speed_mps: 0.3, generate: {}, segments: [{straight_m: 1}]}"),
              HasSubstr("plan.generate: {}: wanted either segments or generate, not both"));
  EXPECT_THAT(message(lab(), "{speed_mps: 0.3}"),
              HasSubstr("plan.segments: missing: wanted a list, or `generate` in its place"));
}

}  // namespace
}  // namespace groundloop::sim
