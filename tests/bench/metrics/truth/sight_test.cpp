#include "bench/metrics/truth/sight.h"

#include <gtest/gtest.h>

#include "tests/sim/truth/scene.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using slam::Pose;
using slam::StereoRig;

/// A wall whose face is at x = 4 m and a pillar 0.2 m wide whose face is at x = 2 m on the optical axis.
class Views : public testing::Test {
 protected:
  static StereoRig make_rig() { return slam::centred_rig(640, 480, 500, 0.08); }
  static Pose camera(double x_m, double y_m, double yaw_rad = 0) {
    Pose T_world_body = Pose::Identity();
    T_world_body.linear() = slam::so3_exp({0, 0, yaw_rad});
    T_world_body.translation() << x_m, y_m, 1;
    return T_world_body * StereoRig::level_camera(Vector3d::Zero());
  }

  StereoRig rig_ = make_rig();
  sim::Scene scene_{
      "<geom type='box' size='0.5 20 20' pos='4.5 0 0'/><geom type='box' size='0.1 0.1 10' pos='2.1 0 0'/>"};
  sim::TruthWorld world_{*scene_.model, *scene_.data, -1};
  Sight sight_{world_, rig_};
};

TEST_F(Views, SurfaceAndPixelAreInverse) {
  const Vector2d px(419.5, 189.5);  // 100 px right, 50 px up: 0.8 m and 0.4 m on the wall
  const auto p = sight_.surface(camera(0, 0), px);
  ASSERT_TRUE(p);
  EXPECT_LT((*p - Vector3d(4, -0.8, 1.4)).norm(), 1e-9);
  EXPECT_LT((*sight_.left_px(camera(0, 0), *p) - px).norm(), 1e-9);
  // fx b / Z = 10 px
  EXPECT_LT((*sight_.right_px(camera(0, 0), *p) - Vector2d(409.5, 189.5)).norm(), 1e-9);
  // one metre nearer the offsets grow by 4 / 3
  EXPECT_LT((*sight_.left_px(camera(1, 0), *p) - Vector2d(319.5 + 400.0 / 3, 239.5 - 200.0 / 3)).norm(),
            1e-9);
}

TEST_F(Views, HiddenBehindAndOutsideAreNotSeen) {
  const Vector3d behind_pillar(4, 0, 1);
  EXPECT_FALSE(sight_.left_px(camera(0, 0), behind_pillar));
  EXPECT_TRUE(sight_.left_px(camera(0, 1), behind_pillar));
  EXPECT_FALSE(sight_.left_px(camera(0, 0, M_PI), Vector3d(4, 1, 1))) << "behind the camera";
  EXPECT_FALSE(sight_.left_px(camera(0, 0), Vector3d(4, 3, 1))) << "u = 319.5 - 375";
  // the ray to y = -0.19 passes the pillar's face (x = 2) at -0.095 from the left eye, and at -0.135 from the
  // right one, which is at y = -0.08; mirrored, the right eye is the blind one
  EXPECT_FALSE(sight_.left_px(camera(0, 0), Vector3d(4, -0.19, 1)));
  EXPECT_TRUE(sight_.right_px(camera(0, 0), Vector3d(4, -0.19, 1)));
  EXPECT_TRUE(sight_.left_px(camera(0, 0), Vector3d(4, 0.23, 1)));
  EXPECT_FALSE(sight_.right_px(camera(0, 0), Vector3d(4, 0.23, 1)));
}

TEST_F(Views, ShareSeenIsTheOverlapOfTheImages) {
  sim::Scene wall("<geom type='box' size='0.5 20 20' pos='4.5 0 0'/>");
  const sim::TruthWorld world(*wall.model, *wall.data, -1);
  const Sight sight(world, rig_);
  const auto view = sight.view(camera(0, 0));
  ASSERT_EQ(view.size(), 16U * 12U);
  EXPECT_EQ(sight.share_seen(view, camera(0, 0)), 1);
  // the image is 640 px = 5.12 m wide on the wall; moved by 1.28 m, a quarter of the 16 columns is lost
  EXPECT_EQ(sight.share_seen(view, camera(0, 1.28)), 0.75);
  EXPECT_EQ(sight.share_seen(view, camera(0, -1.28)), 0.75);
  EXPECT_EQ(sight.share_seen(view, camera(0, 6)), 0);
  EXPECT_EQ(sight.share_seen(view, camera(0, 0, M_PI)), 0);
  EXPECT_EQ(sight.share_seen({}, camera(0, 0)), 0);
}

TEST_F(Views, WhatIsHiddenDoesNotCount) {
  const auto view = sight_.view(camera(0, 0));
  EXPECT_EQ(view.size(), 16U * 12U);
  EXPECT_EQ(sight_.share_seen(view, camera(0, 0)), 1);
  // 0.5 m aside (and only 0.5 m / 5.12 m of the wall lost) the pillar hides another part of the wall, and
  // shows another face: count point by point with the members tested above
  const Pose aside = camera(0, 0.5);
  size_t seen = 0;
  for (const Vector3d& p : view) seen += sight_.left_px(aside, p) ? 1 : 0;
  EXPECT_LT(seen, view.size() * 0.9);
  EXPECT_GT(seen, view.size() * 0.7);
  const double share = static_cast<double>(seen) / static_cast<double>(view.size());
  EXPECT_EQ(sight_.share_seen(view, aside), share);
  EXPECT_EQ(sight_.share_seen(view, aside, share), share) << "exact where it is enough";
  EXPECT_LT(sight_.share_seen(view, aside, 0.99), 0.99);
}

}  // namespace
}  // namespace groundloop::bench
