#include "sim/simulation/path_check.h"

#include <gmock/gmock.h>

#include "sim/simulation/simulation.h"
#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

/// Messages when the plan is put into a room with a desk at x 2..3 m, y -0.5..0.5 m; empty when it is
/// accepted.
std::vector<std::string> messages(const std::string& plan, const std::string& more = "") {
  const std::string desk =
      "<geom name='desk_top' type='box' pos='2.5 0 0.72' size='0.5 0.5 0.02'/>"
      "<geom name='desk_leg' type='box' pos='2.5 0 0.1' size='0.5 0.5 0.1'/>";
  const Scenario scenario = pioneer_in(write_world("path", kFloor + desk + more), plan);
  try {
    const World world = World::load(scenario);
    const Simulation simulation(world, load_head(scenario.head.model), scenario);
  } catch (const InputError& e) {
    std::vector<std::string> lines;
    for (const Problem& problem : e.problems()) lines.push_back(problem.text());
    return lines;
  }
  return {};
}

TEST(PathCheck, APathThroughADeskNamesLineSegmentPlaceAndDesk) {
  const auto lines = messages(R"(  speed_mps: 0.2
  segments:
    - {straight_m: 1}
    - {straight_m: 2}
)");
  // the hull's front is 0.176 m ahead of the axle: with 3 cm kept clear it touches the leg at x = 2 from 1.79
  // m on
  EXPECT_THAT(lines, ElementsAre(EndsWith(
                         ".yaml:10: plan.segments[1]: touches desk_leg at x 1.80 m, y 0.00 m: wanted a "
                         "place 0.03 m clear of everything")));
}

TEST(PathCheck, RoundTheDeskIsFine) {
  EXPECT_THAT(
      messages("  speed_mps: 0.2\n  segments: [{straight_m: 1}, {arc: {radius_m: 0.6, angle_deg: 180}}]\n"),
      IsEmpty());
}

TEST(PathCheck, TheTailIsLookedAtWhenTurning) {
  // The robot's rear corners swing 0.33 m round the axle: a post at its side is hit by turning on the spot
  // only.
  const std::string post = "<geom name='post' type='cylinder' pos='0.0 -0.29 0.5' size='0.03 0.5'/>";
  EXPECT_THAT(messages("  speed_mps: 0.2\n  segments: [{straight_m: 0.5}]\n", post), IsEmpty());
  EXPECT_THAT(
      messages("  speed_mps: 0.2\n  segments: [{arc: {radius_m: 0, angle_deg: 90}}]\n", post),
      ElementsAre(MatchesRegex(".*plan.segments\\[0\\]: touches post at x 0.00 m, y 0.00 m: wanted.*")));
}

TEST(PathCheck, AfterAKidnappingThePathIsFollowedFromThere) {
  const std::string plan = "  speed_mps: 0.2\n  segments:\n    - {straight_m: 1}\nfaults:\n";
  EXPECT_THAT(messages(plan + "  - {at_s: 2, kidnap: {x_m: 1, y_m: 3, yaw_deg: 0}}\n"), IsEmpty());
  EXPECT_THAT(messages(plan + "  - {at_s: 2, kidnap: {x_m: 1.5, y_m: 0, yaw_deg: 0}}\n"),
              ElementsAre(MatchesRegex(
                  ".*:9: plan.segments\\[0\\]: touches desk_leg at x 1.8[0-9] m, y 0.00 m: .*")));
  EXPECT_THAT(
      messages(plan + "  - {at_s: 2, kidnap: {x_m: 2.5, y_m: 0.2, yaw_deg: 0}}\n"),
      ElementsAre(
          MatchesRegex(".*:9: plan.segments\\[0\\]: touches desk_leg.*"),
          EndsWith(".yaml:11: faults[0].kidnap: touches desk_leg at x 2.50 m, y 0.20 m: wanted a place "
                   "0.03 m clear of everything")));
}

TEST(PathCheck, AFaultAfterThePlanIsAMistake) {
  EXPECT_THAT(messages("  speed_mps: 0.2\n  segments: [{stop_s: 2}]\nfaults:\n  - {at_s: 3, blackout: {}}\n"),
              ElementsAre(EndsWith(
                  ".yaml:10: faults[0].at_s: 3: wanted a time within the plan, which takes 2.00 s")));
}

TEST(PathCheck, AStartInsideSomethingIsNamedAlone) {
  const std::string box = "<geom name='crate' type='box' pos='0.1 0 0.2' size='0.2 0.2 0.2'/>";
  EXPECT_THAT(
      messages("  speed_mps: 0.2\n  segments: [{straight_m: 2}]\n", box),
      ElementsAre(EndsWith("robot.start: touches crate at x 0.00 m, y 0.00 m: wanted a place 0.03 m clear of "
                           "everything")));
}

}  // namespace
}  // namespace groundloop::sim
