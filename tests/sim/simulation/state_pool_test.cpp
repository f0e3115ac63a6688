#include "sim/simulation/state_pool.h"

#include <gtest/gtest.h>

#include "tests/sim/simulation/test_rooms.h"

namespace groundloop::sim {
namespace {

TEST(StatePool, CopiesAndUsesAgain) {
  const World world = World::load_file(write_world("pool", "<body><freejoint/><geom size='1'/></body>"));
  const World::DataPtr state = world.make_data();
  StatePool pool(world.model());

  state->qpos[2] = 5;
  auto first = pool.copy(*state);
  state->qpos[2] = 6;
  auto second = pool.copy(*state);
  EXPECT_EQ(first->qpos[2], 5);
  EXPECT_EQ(second->qpos[2], 6);

  const mjData* used_before = first.get();
  first.reset();
  state->qpos[2] = 7;
  const auto third = pool.copy(*state);
  EXPECT_EQ(third.get(), used_before) << "nothing new is allocated";
  EXPECT_EQ(third->qpos[2], 7);
  EXPECT_EQ(second->qpos[2], 6);
}

TEST(StatePool, CopiesOutliveThePool) {
  const World world = World::load_file(write_world("pool", "<body><freejoint/><geom size='1'/></body>"));
  auto pool = std::make_unique<StatePool>(world.model());
  const auto copy = pool->copy(*world.make_data());
  pool.reset();
  EXPECT_EQ(copy->qpos[3], 1);
}

}  // namespace
}  // namespace groundloop::sim
