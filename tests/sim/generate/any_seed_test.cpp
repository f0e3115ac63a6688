// Whatever the seed: the world loads, the start is free, the way is clear, smooth and as long as asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/generate/realize.h"
#include "sim/robot/planned_path.h"
#include "tests/sim/generate/recipes.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kSeeds = 200, kSeedsATest = 10;
constexpr double kLength_m = 18, kClearance_m = 0.12, kMinRadius_m = 0.5;
constexpr const char* kStyles[] = {"office", "clutter", "corridor", "doorway", "low_texture"};

class AnySeed : public ::testing::TestWithParam<uint64_t> {
 protected:
  PictureContrast pictures_;
};

double radians(double deg) { return deg * std::numbers::pi / 180; }

/// Follows the segments in small steps, and asks Bullet at each.
void expect_clear(const Scenario& scenario, const TruthWorld& truth) {
  Pose2 at{scenario.robot.start.x_m, scenario.robot.start.y_m, radians(scenario.robot.start.yaw_deg)};
  for (const Segment& segment : scenario.plan.segments) {
    const double turn_rad = segment.arc ? radians(segment.arc->angle_deg) : 0;
    const double length_m = segment.arc ? segment.arc->radius_m * std::abs(turn_rad) : *segment.straight_m;
    const double steps = std::ceil(length_m / 0.1);
    for (double step = 0; step <= steps; ++step) {
      const Pose2 here = driven(at, length_m * step / steps, turn_rad * step / steps);
      const auto hit = truth.collision(here.x_m, here.y_m, here.yaw_rad, kClearance_m);
      ASSERT_FALSE(hit.has_value()) << *hit << " at " << here.x_m << ", " << here.y_m;
    }
    at = driven(at, length_m, turn_rad);
  }
}

TEST_P(AnySeed, GivesAWorldAndAClearWay) {
  for (uint64_t seed = GetParam(); seed < GetParam() + kSeedsATest; ++seed) {
    const std::string style = kStyles[seed % 5];
    // Every style meets every number of laps, but for corridors: a narrow one has no room to turn in, and
    // may be hardly longer than half of the usual way.
    const uint64_t laps = style == "corridor" ? 0 : seed / 5 % 3;
    const double wanted_m = style == "corridor" ? 8 : kLength_m;
    SCOPED_TRACE(fmt::format("seed {}, {}, {} laps", seed, style, laps));
    const Scenario asked = scenario_with(
        fmt::format("{{generate: {{seed: {}, style: {}, textures: {}}}}}", seed, style, textures()),
        fmt::format("{{speed_mps: 0.3, generate: {{seed: {}, length_m: {}, laps: {}}}}}", seed, wanted_m,
                    laps));
    Scenario scenario;
    ASSERT_NO_THROW(scenario = realized(asked, pictures_));

    const World world = World::load(scenario, Looks::kNone);
    const World::DataPtr state = world.make_data();
    expect_clear(scenario, TruthWorld(world, *state));

    double length_m = 0;
    for (const Segment& segment : scenario.plan.segments) {
      if (segment.arc) {
        ASSERT_GE(segment.arc->radius_m, kMinRadius_m);
      }
      length_m += segment.arc ? segment.arc->radius_m * std::abs(radians(segment.arc->angle_deg))
                              : *segment.straight_m;
    }
    if (laps == 0) {
      ASSERT_NEAR(length_m, wanted_m, 1e-9);
      continue;
    }
    // Where a room has no loop so short, laps are longer.
    ASSERT_GE(length_m, 0.5 * wanted_m);
    ASSERT_LE(length_m, 3 * wanted_m);
    const PlannedPath path(scenario.robot.start, scenario.plan, {0.1, 0.3, 10, 3});
    const Pose2 start = path.at(0).T_world_body, end = path.at(path.duration_s()).T_world_body;
    ASSERT_NEAR(end.x_m, start.x_m, 1e-6);
    ASSERT_NEAR(end.y_m, start.y_m, 1e-6);
    ASSERT_NEAR(wrapped(end.yaw_rad - start.yaw_rad), 0, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnySeed, ::testing::Range<uint64_t>(1, kSeeds + 1, kSeedsATest),
                         [](const auto& range) { return fmt::format("From{}", range.param); });

}  // namespace
}  // namespace groundloop::sim
