#include "sim/world/scale.h"

#include <gtest/gtest.h>

#include "sim/world/world.h"
#include "tests/sim/world/scratch.h"

namespace groundloop::sim {
namespace {

const char* const kWorld = R"(<mujoco>
  <statistic extent="3" center="0 0 1"/>
  <worldbody>
    <light name="lamp" pos="0 0 2" attenuation="1 0.5 0.25"/>
    <geom name="box" type="box" size="0.1 0.2 0.3" pos="1 2 0.3"/>
    <body name="ball" pos="0 0 1"><freejoint/><geom name="ball" size="0.1" pos="0.05 0 0" mass="2"/></body>
    <body name="drawer" pos="1 0 0">
      <joint name="drawer" type="slide" limited="true" range="0 0.4"/>
      <geom type="capsule" size="0.05 0.1" mass="1"/>
      <site name="handle" pos="0 0.1 0"/>
    </body>
  </worldbody>
</mujoco>)";

class ScaleTest : public Scratch {};

TEST_F(ScaleTest, LengthsGrowAndInertiaStays) {
  const World small = World::load_file(write("w.xml", kWorld)),
              large = World::load_file(write("w.xml", kWorld));
  // the world's model is constant to everyone else
  scale_model(const_cast<mjModel&>(large.model()), 4);
  const mjModel &a = small.model(), &b = large.model();
  for (int i = 0; i < 3 * a.ngeom; ++i) {
    EXPECT_DOUBLE_EQ(b.geom_size[i], 4 * a.geom_size[i]);
    EXPECT_DOUBLE_EQ(b.geom_pos[i], 4 * a.geom_pos[i]);
  }
  for (int i = 0; i < 3 * a.nbody; ++i) {
    EXPECT_DOUBLE_EQ(b.body_pos[i], 4 * a.body_pos[i]);
    EXPECT_DOUBLE_EQ(b.body_inertia[i], a.body_inertia[i]);
  }
  for (int body = 0; body < a.nbody; ++body) EXPECT_DOUBLE_EQ(b.body_mass[body], a.body_mass[body] / 16);
  EXPECT_DOUBLE_EQ(b.stat.extent, 4 * a.stat.extent);
  EXPECT_DOUBLE_EQ(b.site_pos[1], 4 * a.site_pos[1]);
  const int slide = mj_name2id(&a, mjOBJ_JOINT, "drawer");
  EXPECT_DOUBLE_EQ(b.jnt_range[2 * slide + 1], 1.6);
  EXPECT_DOUBLE_EQ(b.qpos0[2], 4);  // of the free joint
  EXPECT_DOUBLE_EQ(b.qpos0[3], 1);  // its orientation
}

/// Light at a place of the larger world is that of the same place in the smaller one.
TEST_F(ScaleTest, FadingLightReachesAsFar) {
  const World world = World::load_file(write("w.xml", kWorld));
  auto& model = const_cast<mjModel&>(world.model());
  const auto strength = [&](double distance_m) {
    const float* c = model.light_attenuation;
    return 1 / (c[0] + c[1] * distance_m + c[2] * distance_m * distance_m);
  };
  const double before = strength(1.5);
  scale_model(model, 4);
  EXPECT_NEAR(strength(6), before, 1e-6);
}

}  // namespace
}  // namespace groundloop::sim
