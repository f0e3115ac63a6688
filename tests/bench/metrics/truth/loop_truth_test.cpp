#include "bench/metrics/truth/loop_truth.h"

#include <gtest/gtest.h>

#include "tests/sim/truth/scene.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector3d;
using slam::LinkKind;
using slam::LoopLink;
using slam::Pose;
using slam::StereoRig;

/// A square room of 8 m x 8 m about the origin.
class Loops : public testing::Test {
 protected:
  static StereoRig make_rig() {
    StereoRig rig;
    rig.width_px = 640;
    rig.height_px = 480;
    rig.fx_px = rig.fy_px = 500;  // 65 degrees wide
    rig.cx_px = rig.cx_right_px = 319.5;
    rig.cy_px = 239.5;
    rig.baseline_m = 0.08;
    return rig;
  }
  static Pose camera(double x_m, double y_m, double yaw_deg) {
    Pose T_world_body = Pose::Identity();
    T_world_body.linear() = slam::so3_exp({0, 0, yaw_deg * M_PI / 180});
    T_world_body.translation() << x_m, y_m, 1;
    return T_world_body * StereoRig::level_camera(Vector3d::Zero());
  }
  /// Key frames every ten degrees of a turn on the spot; frames count by five.
  static std::vector<TrueView> turn(double degrees) {
    std::vector<TrueView> views;
    for (int i = 0; i * 10 <= degrees; ++i) views.push_back({5 * i, camera(0, 0, 10 * i)});
    return views;
  }
  static LoopLink link(int64_t from, int64_t to, const Pose& T_from_to) {
    LoopLink link;
    link.from_index = from;
    link.to_index = to;
    link.T_from_to = T_from_to;
    return link;
  }

  StereoRig rig_ = make_rig();
  sim::Scene scene_{
      "<geom type='box' size='0.5 5 5' pos='4.5 0 0'/><geom type='box' size='0.5 5 5' pos='-4.5 0 0'/>"
      "<geom type='box' size='5 0.5 5' pos='0 4.5 0'/><geom type='box' size='5 0.5 5' pos='0 -4.5 0'/>"};
  sim::TruthWorld world_{*scene_.model, *scene_.data, -1};
  Sight sight_{world_, rig_};
};

TEST_F(Loops, HalfATurnComesBackToNothing) {
  EXPECT_TRUE(true_revisits(sight_, turn(300)).empty());
  EXPECT_TRUE(true_revisits(sight_, {}).empty());
}

TEST_F(Loops, StandingStillIsNoRevisit) {
  std::vector<TrueView> still;
  for (int i = 0; i < 50; ++i) still.push_back({i, camera(0, 0, 0)});
  EXPECT_TRUE(true_revisits(sight_, still).empty());
}

TEST_F(Loops, AWholeTurnComesBackToItsStart) {
  // The image reaches to 32.6 degrees on both sides. Turned by 30 degrees it shares the columns from
  // 500 tan(-2.6 deg) = -23 px to 320 px, 0.53 of them; turned by 40 degrees from 65 px on, 0.40.
  const auto views = turn(400);
  const auto revisits = true_revisits(sight_, views);
  ASSERT_EQ(revisits.size(), 8U);
  for (size_t i = 0; i < revisits.size(); ++i) {
    EXPECT_EQ(revisits[i].later, 33 + i);
    EXPECT_GE(revisits[i].overlap, kRevisitOverlap);
  }
  // all are at the same spot: of equally near ones it is the first that overlaps enough
  EXPECT_EQ(revisits[3].earlier, 0U);
  EXPECT_EQ(revisits[3].overlap, 1);
}

TEST_F(Loops, SamePlaceIsNearAndTurnedAlike) {
  const Pose here = camera(0, 0, 0);
  const auto overlap = [&](const Pose& T_world_later) {
    return same_place(sight_, here, T_world_later, sight_.view(T_world_later));
  };
  EXPECT_EQ(overlap(here), 1);
  EXPECT_TRUE(overlap(camera(1, 0, 0)));
  EXPECT_FALSE(overlap(camera(2.1, 0, 0))) << "the same wall, but twice as large";
  EXPECT_FALSE(overlap(camera(0, 0, 60)));
  EXPECT_FALSE(overlap(camera(0, 1.9, 40))) << "alike, but it sees another part of the wall";
}

TEST_F(Loops, LinkIsRightWithinItsTolerances) {
  const Pose from = camera(0, 0, 0), to = camera(0.3, 0.2, 10);
  const Pose T_from_to = from.inverse() * to;
  const JudgedLink exact = judge_link(sight_, link(0, 9, T_from_to), from, to);
  EXPECT_TRUE(exact.right);
  EXPECT_LT(exact.error_m, 1e-12);
  EXPECT_GT(exact.overlap, 0.6);

  Pose error = Pose::Identity();
  error.translation() << 0.06, 0, 0.07;  // 0.092 m
  error.linear() = slam::so3_exp({0, 1.9 * M_PI / 180, 0});
  const JudgedLink rough = judge_link(sight_, link(0, 9, T_from_to * error), from, to);
  EXPECT_TRUE(rough.right);
  EXPECT_NEAR(rough.error_m, std::hypot(0.06, 0.07), 1e-12);
  EXPECT_NEAR(rough.error_deg, 1.9, 1e-9);

  error.translation() << 0.08, 0, 0.07;  // 0.106 m
  EXPECT_FALSE(judge_link(sight_, link(0, 9, T_from_to * error), from, to).right);
  error.translation().setZero();
  error.linear() = slam::so3_exp({0, 2.1 * M_PI / 180, 0});
  EXPECT_FALSE(judge_link(sight_, link(0, 9, T_from_to * error), from, to).right);
}

TEST_F(Loops, ImagesThatShareNothingRecogniseNothing) {
  const Pose from = camera(0, 0, 0), to = camera(0, 0, 180);
  LoopLink lucky = link(0, 9, from.inverse() * to);
  EXPECT_EQ(judge_link(sight_, lucky, from, to).overlap, 0);
  EXPECT_FALSE(judge_link(sight_, lucky, from, to).right);
  lucky.kind = LinkKind::kMap;  // a map is matched without images
  EXPECT_TRUE(judge_link(sight_, lucky, from, to).right);
}

TEST_F(Loops, PrecisionAndRecallCountLinksAndKeyFrames) {
  const std::vector<TrueView> views = turn(400);  // comes back at key frames 33 .. 40: frames 165 .. 200
  const std::vector<Revisit> revisits = true_revisits(sight_, views);
  const auto judged = [&](int64_t to, bool right) {
    JudgedLink j{link(0, to, Pose::Identity())};
    j.right = right;
    return j;
  };
  EXPECT_TRUE(score_loops(views, {}, {}).metrics().empty());
  EXPECT_EQ(score_loops(views, revisits, {}).metrics(), (Metrics{{"loop.recall", 0}}));
  // 168 belongs to the key frame of frame 170; a second link to a key frame finds nothing new; a wrong link
  // finds nothing; 50 belongs to no revisit
  const LoopScore score = score_loops(
      views, revisits,
      {judged(168, true), judged(180, true), judged(180, true), judged(185, false), judged(50, true)});
  EXPECT_EQ(score.found, 2U);
  EXPECT_EQ(score.metrics().at("loop.recall"), 2.0 / 8);
  EXPECT_EQ(score.metrics().at("loop.precision"), 4.0 / 5);
  EXPECT_FALSE(score_loops(views, {}, {judged(50, true)}).metrics().contains("loop.recall"));
}

}  // namespace
}  // namespace groundloop::bench
