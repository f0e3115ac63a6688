#include "slam/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "slam/stereo/right_lag.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

StereoRig rig_of_test() { return centred_rig(320, 240, 300, 0.1); }

Pose motion(double x, double y, double z, double rx_deg, double ry_deg, double rz_deg) {
  Vector6d twist;
  twist << x, y, z, rx_deg * kDeg, ry_deg * kDeg, rz_deg * kDeg;
  return se3_exp(twist);
}

/// A slanted textured plane, in the left camera of the key frame, seen from anywhere.
class Plane {
 public:
  /// Point seen by a pixel of a camera at T_kf_camera.
  Eigen::Vector3d point(const Pose& T_kf_camera, double cx_px, double u, double v) const {
    const Eigen::Vector3d ray =
        T_kf_camera.linear() * Eigen::Vector3d((u - cx_px) / rig_.fx_px, (v - rig_.cy_px) / rig_.fy_px, 1);
    const double range = (distance_m_ - normal_.dot(T_kf_camera.translation())) / normal_.dot(ray);
    return T_kf_camera.translation() + range * ray;
  }

  struct View {
    ImagePyramid left, right;
  };
  View view(const Pose& T_kf_left) const {
    const Pose T_kf_right = T_kf_left * Eigen::Translation3d(rig_.baseline_m, 0, 0);
    const cv::Size size(rig_.width_px, rig_.height_px);
    View v;
    v.left.build(draw(size, {}, [&](int x, int y) { return grey(T_kf_left, rig_.cx_px, x, y); }), 4);
    v.right.build(draw(size, {}, [&](int x, int y) { return grey(T_kf_right, rig_.cx_right_px, x, y); }), 4);
    return v;
  }

 private:
  double grey(const Pose& T_kf_camera, double cx_px, int u, int v) const {
    return texture_.at(point(T_kf_camera, cx_px, u, v));
  }

  const StereoRig rig_ = rig_of_test();
  const Texture texture_{21, 0.07, 0.4};
  const Eigen::Vector3d normal_ = Eigen::Vector3d(0.1, -0.15, 1).normalized();
  const double distance_m_ = 2.0;
};

class TrackerTest : public testing::TestWithParam<bool> {
 protected:
  TrackerTest() { see(Pose::Identity()); }

  void see(const Pose& T_kf_left) { view_ = plane_.view(T_kf_left); }

  /// Features on a lattice, reconstructed exactly, matched in the right image.
  void add_lattice(int step_px = 26) {
    for (int v = 30; v < 215; v += step_px) {
      for (int u = 70; u < 290; u += step_px) {
        Feature* f = tracker_.add(view_.left, {static_cast<float>(u), static_cast<float>(v)});
        ASSERT_NE(f, nullptr);
        f->p_kf = plane_.point(Pose::Identity(), rig_.cx_px, u, v);
        const Eigen::Vector3d uvu = rig_.project(f->p_kf);
        f->right = f->left;
        f->right.uv_px.x() = static_cast<float>(uvu.z());
        f->in_right = true;
        f->is_inlier = true;
      }
    }
  }

  /// Of the features whose windows stay well inside both images: how many there are, how many were found in
  /// both, and the largest error [px].
  struct Outcome {
    int visible = 0, found = 0;
    double worst_px = 0;
  };
  Outcome outcome(const Pose& T_kf_left) const {
    Outcome o;
    for (const Feature& f : tracker_.features()) {
      const Eigen::Vector3d uvu = rig_.project(T_kf_left.inverse() * f.p_kf);
      if (uvu.z() < 20 || uvu.x() > 300 || uvu.y() < 20 || uvu.y() > 220) continue;
      ++o.visible;
      if (!f.in_left || !f.in_right) continue;
      ++o.found;
      const Eigen::Vector2d left = uvu.head<2>(), right(uvu.z(), uvu.y());
      o.worst_px = std::max({o.worst_px, (f.left.uv_px.cast<double>() - left).norm(),
                             (f.right.uv_px.cast<double>() - right).norm()});
    }
    return o;
  }

  void track(const ImagePyramid& right, const Pose& T_kf_previous, const Pose& T_kf_left) {
    tracker_.track(view_.left, right, T_kf_previous, T_kf_left, GetParam(), RightLag());
  }

  const StereoRig rig_ = rig_of_test();
  const Plane plane_;
  Plane::View view_;
  Tracker tracker_{rig_, {}, {}, StereoMatcher(rig_, {}, {})};
};

TEST_P(TrackerTest, FindsEveryFeatureWhereAKnownMotionTakesIt) {
  add_lattice();
  const Pose T_kf_left = motion(0.05, -0.02, 0.12, 0.5, 2, 1.5);
  see(T_kf_left);
  track(view_.right, Pose::Identity(), T_kf_left);
  const Outcome o = outcome(T_kf_left);
  EXPECT_GT(o.visible, 45);
  EXPECT_EQ(o.found, o.visible);
  EXPECT_LT(o.worst_px, 0.1);
}

TEST_P(TrackerTest, ASomewhatWrongPredictionIsGoodEnough) {
  add_lattice();
  const Pose T_kf_left = motion(0.05, -0.02, 0.12, 0.5, 2, 1.5);
  see(T_kf_left);
  for (const Pose& wrong : {motion(0, 0, 0.02, 0, 0.6, 0), motion(0.02, 0.01, 0, 0.4, -0.4, 1)}) {
    tracker_.clear();
    see(Pose::Identity());
    add_lattice();
    see(T_kf_left);
    track(view_.right, Pose::Identity(), T_kf_left * wrong);
    const Outcome o = outcome(T_kf_left);
    EXPECT_EQ(o.found, o.visible);
    EXPECT_LT(o.worst_px, 0.1);
  }
}

TEST_P(TrackerTest, StaysOnItOverManyFramesWithoutDrift) {
  add_lattice();
  // The plan says half of what happens; every frame is matched with the first view, so nothing adds up.
  Pose T_kf_previous = Pose::Identity();
  for (int i = 1; i <= 8; ++i) {
    const Pose T_kf_left = motion(0.012 * i, 0, 0.02 * i, 0, 0.5 * i, -0.8 * i);
    see(T_kf_left);
    track(view_.right, T_kf_previous, T_kf_previous * motion(0.006, 0, 0.01, 0, 0.25, -0.4));
    const Outcome o = outcome(T_kf_left);
    EXPECT_GE(o.found, o.visible - 1) << i;
    EXPECT_LT(o.worst_px, 0.1) << i;
    T_kf_previous = T_kf_left;
  }
}

TEST_P(TrackerTest, AFeatureBehindTheCameraIsLost) {
  add_lattice();
  track(view_.right, Pose::Identity(), motion(0, 0, 5, 0, 0, 0));
  for (const Feature& f : tracker_.features()) EXPECT_FALSE(f.in_left || f.in_right);
}

TEST_P(TrackerTest, AFeatureOutsideTheRightImageIsInTheLeftOnly) {
  Feature* f = tracker_.add(view_.left, {20, 120});
  ASSERT_NE(f, nullptr);
  f->p_kf = plane_.point(Pose::Identity(), rig_.cx_px, 20, 120);
  track(view_.right, Pose::Identity(), Pose::Identity());
  EXPECT_TRUE(tracker_.features()[0].in_left);
  EXPECT_FALSE(tracker_.features()[0].in_right);
}

TEST_P(TrackerTest, RowsThatDisagreeAreNoStereoPair) {
  add_lattice();
  const Pose lower = motion(0, -0.02, 0, 0, 0, 0);  // about 3 px
  const Plane::View other = plane_.view(lower);
  track(other.right, Pose::Identity(), Pose::Identity());
  for (const Feature& f : tracker_.features()) EXPECT_FALSE(f.in_right);
}

TEST_P(TrackerTest, TrackAgainFindsWhatAWrongPlanMissed) {
  add_lattice();
  const Pose T_kf_left = motion(0.05, -0.02, 0.12, 0.5, 2, 1.5);
  see(T_kf_left);
  track(view_.right, Pose::Identity(), motion(0, 0, 0, 0, -14, 20));
  for (Feature& f : tracker_.features()) f.is_inlier = false;
  const Outcome before = outcome(T_kf_left);
  tracker_.track_again(view_.left, view_.right, Pose::Identity(), T_kf_left, RightLag());
  const Outcome after = outcome(T_kf_left);
  EXPECT_LT(before.found, after.visible / 2);
  EXPECT_EQ(after.found, after.visible);
  EXPECT_LT(after.worst_px, 0.1);
}

TEST_P(TrackerTest, TrackAgainLeavesGoodFeaturesAlone) {
  add_lattice();
  track(view_.right, Pose::Identity(), Pose::Identity());
  std::vector<Eigen::Vector2f> before;
  for (Feature& f : tracker_.features()) {
    f.is_inlier = true;
    before.push_back(f.left.uv_px);
  }
  tracker_.track_again(view_.left, view_.right, Pose::Identity(), motion(0.1, 0, 0, 0, 3, 0), RightLag());
  for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(tracker_.features()[i].left.uv_px, before[i]);
}

TEST_P(TrackerTest, IdsAreNeverUsedAgainAndTemplatesAre) {
  add_lattice();
  const size_t count = tracker_.features().size();
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(tracker_.features()[i].id, static_cast<int64_t>(i));

  tracker_.remove_if([](const Feature& f) { return f.id % 3 == 0; });
  std::vector<int> slots;
  int64_t previous = -1;
  for (const Feature& f : tracker_.features()) {
    EXPECT_NE(f.id % 3, 0);
    EXPECT_GT(f.id, previous);  // the order of the rest stays
    EXPECT_EQ(f.slot, f.id);    // and each keeps its first view
    previous = f.id;
    slots.push_back(f.slot);
  }
  const Feature* fresh = tracker_.add(view_.left, {150, 110});
  ASSERT_NE(fresh, nullptr);
  EXPECT_EQ(fresh->id, static_cast<int64_t>(count));
  EXPECT_LT(fresh->slot, static_cast<int>(count));
  EXPECT_EQ(std::count(slots.begin(), slots.end(), fresh->slot), 0);  // nobody else's

  tracker_.clear();
  EXPECT_TRUE(tracker_.features().empty());
  add_lattice();
  EXPECT_EQ(tracker_.features().front().id, static_cast<int64_t>(count) + 1);
  for (const Feature& f : tracker_.features()) EXPECT_LT(f.slot, static_cast<int>(count));
}

TEST_P(TrackerTest, TheFirstViewSurvivesTheRemovalOfOthers) {
  add_lattice();
  const PatchBuffer before = tracker_.first_view(tracker_.features()[7]).level[0].grey;
  const int64_t id = tracker_.features()[7].id;
  tracker_.remove_if([&](const Feature& f) { return f.id != id; });
  for (float u = 60; u < 280; u += 9) tracker_.add(view_.left, {u, 77});
  ASSERT_EQ(tracker_.features()[0].id, id);
  EXPECT_EQ(tracker_.first_view(tracker_.features()[0]).level[0].grey, before);
}

TEST_P(TrackerTest, AWindowThatIsNoGoodIsNotAdded) {
  EXPECT_EQ(tracker_.add(view_.left, {3, 3}), nullptr);
  EXPECT_TRUE(tracker_.features().empty());
  const Feature* f = tracker_.add(view_.left, {150, 110});
  ASSERT_NE(f, nullptr);
  EXPECT_EQ(f->id, 0);  // the refusal took no number
  EXPECT_TRUE(f->in_left);
  EXPECT_FALSE(f->in_right);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithAPlan, TrackerTest, testing::Bool());

}  // namespace
}  // namespace groundloop::slam
