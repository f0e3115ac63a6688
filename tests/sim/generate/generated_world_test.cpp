#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "sim/generate/realize.h"
#include "sim/world/generate/generate.h"
#include "tests/sim/generate/recipes.h"

namespace groundloop::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kPlan = "{speed_mps: 0.3, segments: [{straight_m: 0.1}]}";

WorldRecipe recipe(uint64_t seed, WorldStyle style) {
  WorldRecipe recipe;
  recipe.seed = seed;
  recipe.style = style;
  recipe.textures = textures();
  return recipe;
}

std::vector<std::string> messages(const std::string& world, const std::string& plan) {
  try {
    realized(scenario_with(world, plan));
  } catch (const InputError& error) {
    std::vector<std::string> texts;
    for (const Problem& problem : error.problems()) {
      texts.push_back(Problem{"", problem.line, problem.key, problem.value, problem.wanted}.text());
    }
    return texts;
  }
  return {};
}

TEST(GeneratedWorld, IsAFunctionOfItsSeed) {
  std::set<std::string> different;
  for (const auto& [style, name] : EnumNames<WorldStyle>::names) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
      const std::string text = generated_world(recipe(seed, style));
      EXPECT_EQ(generated_world(recipe(seed, style)), text);
      different.insert(text.substr(text.find("<asset>")));
    }
  }
  EXPECT_EQ(different.size(), 15U);
}

TEST(GeneratedWorld, IsAsLargeAsAskedAndClosed) {
  const Scenario scenario = scenario_with(
      fmt::format("{{generate: {{seed: 3, style: office, size_m: [9, 7], textures: {}}}}}", textures()), kPlan);
  const World world = World::load(scenario, Looks::kNone);
  const World::DataPtr state = world.make_data();
  const TruthWorld truth(world, *state);
  // From above all furniture, a ray to each side meets the wall's face; and lamps hang from a ceiling.
  const Eigen::Vector3d above(0.1, 0.2, 2.4);
  EXPECT_NEAR(truth.cast(above, Eigen::Vector3d::UnitX(), 50)->p_world.x(), 4.5, 0.03);
  EXPECT_NEAR(truth.cast(above, -Eigen::Vector3d::UnitX(), 50)->p_world.x(), -4.5, 0.03);
  EXPECT_NEAR(truth.cast(above, Eigen::Vector3d::UnitY(), 50)->p_world.y(), 3.5, 0.03);
  EXPECT_NEAR(truth.cast(above, -Eigen::Vector3d::UnitY(), 50)->p_world.y(), -3.5, 0.03);
  EXPECT_TRUE(truth.cast(above, Eigen::Vector3d::UnitZ(), 50).has_value());
}

TEST(GeneratedWorld, FloorsAreOfTheKindAsked) {
  for (const auto& [floor, texture] : {std::pair(FloorKind::kCarpet, "carpet"), {FloorKind::kTiles, "floor_tiles"}}) {
    WorldRecipe asked = recipe(5, WorldStyle::kOffice);
    asked.floor = floor;
    asked.reflectance = 0.25;
    const std::string text = generated_world(asked);
    const size_t geom = text.find("name=\"floor\"");
    EXPECT_THAT(text.substr(geom, 100), HasSubstr(fmt::format("material=\"{}.", texture)));
    EXPECT_THAT(text, HasSubstr("reflectance=\"0.25\""));
  }
}

TEST(GeneratedWorld, RoomsOfADoorwayAreJoined) {
  const Scenario scenario = scenario_with(
      fmt::format("{{generate: {{seed: 4, style: doorway, size_m: [10, 6], textures: {}}}}}", textures()), kPlan);
  const std::string text = generated_text(scenario).value();
  EXPECT_THAT(text, HasSubstr("partition_1"));
}

TEST(GeneratedWorld, WrongRecipesAreNamed) {
  const std::string where = "textures: " + textures();
  EXPECT_THAT(messages("{generate: {size_m: [9], " + where + "}}", kPlan),
              ElementsAre(":3: world.generate.size_m: [9]: wanted [x, y] of at least [6, 5] for this style"));
  EXPECT_THAT(messages("{generate: {style: corridor, size_m: [20, 2], " + where + "}}", kPlan),
              ElementsAre(":3: world.generate.size_m: [20, 2]: wanted [x, y] of at least [8, 2.4] for this style"));
  EXPECT_THAT(messages("{generate: {style: castle, " + where + "}}", kPlan),
              ElementsAre(HasSubstr("world.generate.style: castle: wanted one of: office")));
  EXPECT_THAT(messages("{generate: {textures: /nowhere}}", kPlan),
              ElementsAre(HasSubstr("world.generate.textures: /nowhere: wanted a folder of the house's textures")));
  EXPECT_THAT(messages("{generate: {" + where + "}, file: models/worlds/lab.xml}", kPlan),
              ::testing::Contains(HasSubstr("wanted exactly one of: file, generate")));
}

TEST(GeneratedWorld, TheScenariosSeedIsTheDefault) {
  Scenario asked = scenario_with("{generate: {textures: " + textures() + "}}", kPlan);
  asked.seed = 12;
  const Scenario scenario = realized(asked);
  EXPECT_EQ(scenario.world.generate->seed, 12U);
  EXPECT_EQ(generated_text(scenario), generated_world(recipe(12, WorldStyle::kOffice)));
}

}  // namespace
}  // namespace groundloop::sim
