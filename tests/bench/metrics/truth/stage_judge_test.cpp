#include "bench/metrics/truth/stage_judge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/truth/scene.h"

namespace groundloop::bench {
namespace {

using Eigen::Vector3d;
using slam::FeatureObservation;
using slam::FrameResult;
using slam::Pose;
using slam::StereoRig;

/// A wall whose face is at x = 4 m, with a pillar 0.2 m wide in front of it at x = 2 m on the optical axis.
class Stages : public testing::Test {
 protected:
  static StereoRig make_rig() {
    StereoRig rig;
    rig.width_px = 640;
    rig.height_px = 480;
    rig.fx_px = rig.fy_px = 500;
    rig.cx_px = rig.cx_right_px = 320;
    rig.cy_px = 240;
    rig.baseline_m = 0.08;
    return rig;
  }
  static Pose camera_at(double x_m) { return StereoRig::level_camera({x_m, 0, 1}); }

  /// A feature on a surface at this depth: where it would be seen without any error.
  FeatureObservation feature(int64_t id, double u_px, double v_px, double depth_m) const {
    FeatureObservation f;
    f.id = id;
    f.u_left_px = static_cast<float>(u_px);
    f.v_left_px = f.v_right_px = static_cast<float>(v_px);
    f.u_right_px = static_cast<float>(u_px - rig_.fx_px * rig_.baseline_m / depth_m);
    f.has_right = true;
    return f;
  }
  static FrameResult frame(std::vector<FeatureObservation> features) {
    FrameResult result;
    result.features = std::move(features);
    return result;
  }

  StereoRig rig_ = make_rig();
  sim::Scene scene_{
      "<geom type='box' size='0.5 10 10' pos='4.5 0 0'/><geom type='box' size='0.1 0.1 10' pos='2.1 0 0'/>"};
  sim::TruthWorld truth_{*scene_.model, *scene_.data, -1};
  StageJudge judge_{truth_, rig_};
};

TEST_F(Stages, PerfectFeaturesHaveNoError) {
  // the wall at depth 4 is seen at u = 420; from 1 m nearer the same point is at 320 + 100 * 4/3
  judge_.judge(frame({feature(1, 420, 300, 4), feature(2, 320, 240, 2)}), camera_at(0));
  const StageErrors second = judge_.judge(
      frame({feature(1, 320 + 100 * 4.0 / 3, 240 + 60 * 4.0 / 3, 3), feature(2, 320, 240, 1)}), camera_at(1));
  EXPECT_EQ(second.disparity_px.inliers, 2);
  EXPECT_EQ(second.track_px.inliers, 2);
  const Metrics metrics = judge_.total().metrics();
  EXPECT_LT(metrics.at("stage.disparity_rmse_px"), 1e-4);
  EXPECT_LT(metrics.at("stage.track_rmse_px"), 1e-4);
  EXPECT_LT(metrics.at("stage.point_rmse_m"), 1e-4);
  EXPECT_EQ(metrics.at("stage.stereo_outlier_fraction"), 0);
  EXPECT_EQ(metrics.at("stage.track_outlier_fraction"), 0);
  EXPECT_FALSE(metrics.contains("stage.registration_trans_m"));
}

TEST_F(Stages, DisparityErrorsAreTheOnesPutIn) {
  FeatureObservation a = feature(1, 420, 300, 4), b = feature(2, 450, 200, 4), c = feature(3, 500, 200, 4);
  a.u_right_px += 0.3F;  // disparity 9.7 for 10
  b.u_right_px -= 0.4F;
  c.u_right_px -= 7;  // an outlier
  const StageErrors errors = judge_.judge(frame({a, b, c}), camera_at(0));
  EXPECT_NEAR(*errors.disparity_px.rmse(), std::sqrt((0.09 + 0.16) / 2), 1e-5);
  EXPECT_NEAR(*errors.disparity_px.outlier_fraction(), 1.0 / 3, 1e-12);
  // the error of a point lies along its ray: Z (10/9.7 - 1) and Z (10/10.4 - 1), times the ray's length at z
  // = 1
  const double error_a = (40 / 9.7 - 4) * Vector3d(0.2, 0.12, 1).norm();
  const double error_b = (40 / 10.4 - 4) * Vector3d(0.26, -0.08, 1).norm();
  EXPECT_NEAR(*errors.point_m.rmse(), std::sqrt((error_a * error_a + error_b * error_b) / 2), 1e-5);
}

TEST_F(Stages, TrackErrorsAreAgainstTheFirstView) {
  judge_.judge(frame({feature(1, 420, 300, 4), feature(2, 500, 240, 4)}), camera_at(0));
  FeatureObservation a = feature(1, 420, 300, 4), b = feature(2, 500, 240, 4);
  a.u_left_px += 0.3F;
  a.v_left_px -= 0.4F;
  b.u_left_px += 5;
  const StageErrors still = judge_.judge(frame({a, b}), camera_at(0));
  EXPECT_NEAR(*still.track_px.rmse(), 0.5, 1e-4);
  EXPECT_EQ(still.track_px.outliers, 1);
  // drift adds up: another 0.3 px is 0.6 px from the first view
  a.u_left_px += 0.3F;
  const StageErrors third = judge_.judge(frame({a}), camera_at(0));
  EXPECT_NEAR(*third.track_px.rmse(), std::hypot(0.6, 0.4), 1e-4);
}

TEST_F(Stages, FeatureWithoutAMatchIsTrackedButHasNoDisparity) {
  FeatureObservation a = feature(1, 420, 300, 4);
  a.has_right = false;
  EXPECT_FALSE(judge_.judge(frame({a}), camera_at(0)).disparity_px.outlier_fraction());
  const StageErrors second = judge_.judge(frame({a}), camera_at(0));
  EXPECT_EQ(second.track_px.inliers, 1);
  EXPECT_FALSE(second.metrics().contains("stage.disparity_rmse_px"));
}

TEST_F(Stages, CornerBesideTheEdgeBelongsToTheNearSide) {
  // the pillar ends at y = -0.1: u = 320 + 500 * 0.1 / 2 = 345; the feature is 0.6 px beside it
  const StageErrors near = judge_.judge(frame({feature(1, 345.6, 240, 2)}), camera_at(0));
  EXPECT_EQ(near.disparity_px.outliers, 0);
  EXPECT_LT(*near.disparity_px.rmse(), 1e-4);
  const StageErrors far = judge_.judge(frame({feature(2, 346.6, 240, 2)}), camera_at(0));
  EXPECT_EQ(far.disparity_px.outliers, 1);
  // its first view is on the pillar, so it stays on the pillar
  const StageErrors nearer = judge_.judge(frame({feature(1, 320 + 25.6 * 2, 240, 1)}), camera_at(1));
  EXPECT_EQ(nearer.track_px.outliers, 0);
}

TEST_F(Stages, FeatureThatDiedStartsAnew) {
  judge_.judge(frame({feature(1, 420, 300, 4)}), camera_at(0));
  judge_.judge(frame({}), camera_at(0));
  EXPECT_EQ(judge_.judge(frame({feature(1, 470, 300, 4)}), camera_at(0)).track_px.outliers, 0);
}

TEST_F(Stages, RegistrationIsKeyFrameToKeyFrame) {
  const auto key_frame = [&](const Pose& T_map_left, int segment) {
    FrameResult result;
    result.is_key_frame = true;
    result.segment = segment;
    result.T_map_left = T_map_left;
    return result;
  };
  Pose T_world_map = Pose::Identity();  // any start of the map will do
  T_world_map.translation() << 3, -2, 1;
  T_world_map.linear() = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  const auto in_map = [&](const Pose& T_world_left) -> Pose { return T_world_map.inverse() * T_world_left; };

  EXPECT_FALSE(judge_.judge(key_frame(in_map(camera_at(0)), 0), camera_at(0)).registration_trans_m.rmse());
  judge_.judge(frame({}), camera_at(0.3));  // no key frame
  // 0.5 m forward, estimated 0.51 m and turned by 0.02 rad
  Pose T_error = Pose::Identity();
  T_error.translation() << 0, 0, 0.01;
  T_error.linear() = Eigen::AngleAxisd(0.02, Vector3d::UnitY()).toRotationMatrix();
  const Pose estimate = in_map(camera_at(0.5)) * T_error;
  const StageErrors one = judge_.judge(key_frame(estimate, 0), camera_at(0.5));
  EXPECT_NEAR(*one.registration_trans_m.rmse(), 0.01, 1e-12);
  EXPECT_NEAR(*one.registration_rot_deg.rmse(), 0.02 * 180 / M_PI, 1e-9);
  // the next motion is exact, whatever was wrong before
  const Pose exact = estimate * camera_at(0.5).inverse() * camera_at(1.2);
  EXPECT_NEAR(*judge_.judge(key_frame(exact, 0), camera_at(1.2)).registration_trans_m.rmse(), 0, 1e-12);
  EXPECT_NEAR(*judge_.total().registration_trans_m.rmse(), 0.01 / std::sqrt(2.0), 1e-12);
  // a new segment does not continue the old one
  EXPECT_FALSE(judge_.judge(key_frame(exact, 1), camera_at(2)).registration_trans_m.rmse());
}

}  // namespace
}  // namespace groundloop::bench
