// scenarios/faults: one a kind, all of them in the same small room.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "sim/simulation/simulation.h"

namespace groundloop::sim {
namespace {

TEST(FaultScenarios, ThereIsOneForEveryKindAndAllCanBeDriven) {
  std::set<std::string> kinds;
  std::unique_ptr<World> world;
  for (const auto& entry : std::filesystem::directory_iterator("scenarios/faults")) {
    SCOPED_TRACE(entry.path().string());
    const Scenario scenario = load_scenario(entry.path().string());
    if (!world) world = std::make_unique<World>(World::load(scenario, Looks::kNone));
    const Simulation simulation(*world, load_head(scenario.head.model), scenario);
    ASSERT_EQ(scenario.faults.size(), 1U);
    EXPECT_EQ(scenario.faults[0].kind(), entry.path().stem());
    EXPECT_EQ(scenario.name, entry.path().stem()) << "named as its file";
    EXPECT_FALSE(scenario.summary.empty());
    EXPECT_GT(simulation.planned_duration_s(), scenario.faults[0].at_s + 5) << "time to recover";
    kinds.insert(scenario.faults[0].kind());
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"blackout", "blur", "dirt", "drop", "duplicate", "encoder",
                                          "exposure", "flash", "kidnap", "knock", "late", "swap",
                                          "trigger_offset", "wheel_slip"}));
}

}  // namespace
}  // namespace groundloop::sim
