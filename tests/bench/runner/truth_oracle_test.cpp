#include "bench/runner/truth_oracle.h"

#include <gtest/gtest.h>

#include "tests/sim/truth/scene.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using slam::OracleStage;
using slam::Pose;
using slam::StereoRig;

/// A wall whose face is at x = 4 m, a pillar 0.2 m wide before it (face at x = 2 m, y = 0), and a camera that
/// drives: frame k is at (0.1 k, 0); from frame 10 on it looks back.
class Oracles : public testing::Test {
 protected:
  static StereoRig make_rig() { return slam::centred_rig(640, 480, 500, 0.08); }
  static Pose pose(int64_t frame) {
    Pose T_world_body = Pose::Identity();
    T_world_body.linear() = slam::so3_exp({0, 0, frame < 10 ? 0 : M_PI});
    T_world_body.translation() << 0.1 * static_cast<double>(frame), 0, 1;
    return T_world_body * StereoRig::level_camera(Vector3d::Zero());
  }

  sim::Scene scene_{
      "<geom type='box' size='0.5 20 20' pos='4.5 0 0'/><geom type='box' size='0.1 0.1 10' pos='2.1 0 0'/>"};
  sim::TruthWorld world_{*scene_.model, *scene_.data, -1};
  TruthOracle oracle_{{OracleStage::kTracking, OracleStage::kLoops}, world_, make_rig(), pose};
};

TEST_F(Oracles, ReplaceTheStagesTheyAreMadeFor) {
  EXPECT_TRUE(oracle_.replaces(OracleStage::kTracking));
  EXPECT_TRUE(oracle_.replaces(OracleStage::kLoops));
  EXPECT_FALSE(oracle_.replaces(OracleStage::kStereo));
  EXPECT_FALSE(oracle_.replaces(OracleStage::kMotion));
}

TEST_F(Oracles, TracksTheSurfacePoint) {
  const auto match = oracle_.track(0, {419.5, 289.5}, 5);  // depth 4, then 3.5
  ASSERT_TRUE(match);
  EXPECT_LT((match->left_px - Vector2d(319.5 + 100 * 4 / 3.5, 239.5 + 50 * 4 / 3.5)).norm(), 1e-9);
  ASSERT_TRUE(match->right_px);
  EXPECT_LT((*match->right_px - match->left_px + Vector2d(40 / 3.5, 0)).norm(), 1e-9);
  EXPECT_FALSE(oracle_.track(0, {419.5, 289.5}, 10)) << "it looks back";
  EXPECT_FALSE(oracle_.track(10, {319.5, 239.5}, 0)) << "there is nothing to see there";
}

TEST_F(Oracles, TracksInOneImageWhatThePillarHidesInTheOther) {
  // y = 0.21 on the wall, 3.5 m away: 30 px left of the middle. Its ray passes the pillar's corner (x = 2,
  // y = 0.1) beside it from the left eye, and through the pillar from the right one.
  const auto match = oracle_.track(0, {319.5 - 500 * 0.24 / 4, 239.5}, 1);
  ASSERT_TRUE(match);
  EXPECT_FALSE(match->right_px);
  EXPECT_FALSE(oracle_.disparity_px(1, match->left_px));
}

TEST_F(Oracles, DisparityIsThatOfTheSurfaceUnderThePixel) {
  EXPECT_NEAR(*oracle_.disparity_px(0, {419.5, 239.5}), 10, 1e-9);  // 500 * 0.08 / 4
  EXPECT_NEAR(*oracle_.disparity_px(0, {330, 239.5}), 20, 1e-9);    // the pillar
  EXPECT_NEAR(*oracle_.disparity_px(5, {330, 100}), 40 / 1.5, 1e-9);
  EXPECT_FALSE(oracle_.disparity_px(0, {5, 239.5})) << "outside the right image";
  EXPECT_FALSE(oracle_.disparity_px(10, {319.5, 239.5}));
}

TEST_F(Oracles, MotionIsExact) {
  const auto T_3_7 = oracle_.T_from_to(3, 7);
  ASSERT_TRUE(T_3_7);
  EXPECT_LT((T_3_7->translation() - Vector3d(0, 0, 0.4)).norm(), 1e-12);
  EXPECT_NEAR(slam::rotation_angle_rad(oracle_.T_from_to(3, 12)->linear()), M_PI, 1e-9);
}

TEST_F(Oracles, LoopsAreWhereTheSamePlaceIsSeen) {
  const auto T_3_7 = oracle_.loop_T_from_to(3, 7);
  ASSERT_TRUE(T_3_7);
  EXPECT_LT((T_3_7->translation() - Vector3d(0, 0, 0.4)).norm(), 1e-12);
  EXPECT_FALSE(oracle_.loop_T_from_to(3, 12));
}

}  // namespace
}  // namespace groundloop::bench
