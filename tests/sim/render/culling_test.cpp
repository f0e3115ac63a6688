#include "sim/render/culling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace groundloop::sim {
namespace {

using Eigen::Vector3d;

// At the origin, looking along z, 45 degrees to each side and 3-4-5 up and down.
const auto kPyramid = view_pyramid(Vector3d::Zero(), Eigen::Matrix3d::Identity(), {-1, 1, -0.75, 0.75});

TEST(Culling, SpheresInsideOutsideAndOnTheEdge) {
  EXPECT_TRUE(may_be_seen({0, 0, 5}, 0.1, kPyramid, {}));
  EXPECT_FALSE(may_be_seen({0, 0, -5}, 0.1, kPyramid, {}));
  EXPECT_TRUE(may_be_seen({0, 0, -5}, 6, kPyramid, {}));  // the camera is inside
  // (0, 5, 5) lies 1 m below the lower side: 5 * 4/5 - 5 * 3/5.
  EXPECT_FALSE(may_be_seen({0, 5, 5}, 0.99, kPyramid, {}));
  EXPECT_TRUE(may_be_seen({0, 5, 5}, 1.01, kPyramid, {}));
  EXPECT_FALSE(may_be_seen({-5 - std::sqrt(2.0), 0, 5}, 0.99, kPyramid, {}));
  EXPECT_TRUE(may_be_seen({-5 - std::sqrt(2.0), 0, 5}, 1.01, kPyramid, {}));
}

TEST(Culling, MirrorImagesCount) {
  const HalfSpace floor{{0, -1, 0}, -2};  // y = 2 below the camera
  EXPECT_FALSE(may_be_seen({0, -3, 2}, 0.1, kPyramid, {}));
  EXPECT_FALSE(may_be_seen({0, -3, 2}, 0.1, kPyramid, {floor}));  // image at y = 7, too low at z = 2
  EXPECT_TRUE(may_be_seen({0, -3, 20}, 0.1, kPyramid, {floor}));
  EXPECT_TRUE(may_be_seen({0, 1.2, -1}, 0.1, kPyramid,
                          {floor, {{0, 0, -1}, -3}}));  // behind, seen in a mirror at z = 3
}

TEST(Culling, FollowsTheCamera) {
  Eigen::Matrix3d R_world_camera;  // looks along the world's x
  R_world_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const auto pyramid = view_pyramid({10, 0, 1}, R_world_camera, {-1, 1, -0.75, 0.75});
  EXPECT_TRUE(may_be_seen({14, 3.5, 1}, 0.1, pyramid, {}));
  EXPECT_FALSE(may_be_seen({14, 4.5, 1}, 0.1, pyramid, {}));
  EXPECT_FALSE(may_be_seen({6, 0, 1}, 0.1, pyramid, {}));
}

}  // namespace
}  // namespace groundloop::sim
