#include "slam/pipeline/pipeline.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "slam/pipeline/state_hash.h"
#include "slam/stereo/disparity.h"
#include "tests/slam/pipeline/box_room.h"

namespace groundloop::slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180;
constexpr TrackingStatus kStarted = TrackingStatus::kStarted;
constexpr TrackingStatus kTracking = TrackingStatus::kTracking;
constexpr TrackingStatus kRepeated = TrackingStatus::kRepeated;
constexpr TrackingStatus kLost = TrackingStatus::kLost;

double distance_m(const Pose& a, const Pose& b) { return (a.translation() - b.translation()).norm(); }
double angle_deg(const Pose& a, const Pose& b) {
  return rotation_angle_rad(a.linear().transpose() * b.linear()) / kDeg;
}

class Preset : public testing::TestWithParam<std::string> {
 protected:
  const BoxRoom room_;
};
INSTANTIATE_TEST_SUITE_P(All, Preset, testing::ValuesIn(preset_names()),
                         [](const auto& tested) { return tested.param; });

TEST_P(Preset, FollowsAnArcThroughARoom) {
  constexpr int64_t kFrames = 15;
  Pipeline core(room_.rig(), preset(GetParam()));
  std::vector<int64_t> key_frames;
  for (int64_t i = 0; i < kFrames; ++i) {
    const FrameResult result = core.process(room_.frame(i));
    EXPECT_EQ(result.index, i);
    EXPECT_EQ(result.status, i == 0 ? kStarted : kTracking) << i << ": " << result.message;
    EXPECT_EQ(result.message, "");
    EXPECT_EQ(result.segment, 0);
    const Pose truth = room_.T_map_left(static_cast<double>(i));
    EXPECT_LT(distance_m(result.T_map_left, truth), 0.02) << i;
    EXPECT_LT(angle_deg(result.T_map_left, truth), 0.4) << i;
    if (i > 0) {
      EXPECT_GT(result.features_tracked, 60) << i;
      EXPECT_GT(result.inliers, 0.8 * result.features_tracked) << i;
      EXPECT_GT(result.residual_px, 0) << i;
      EXPECT_LT(result.residual_px, 0.6) << i;
      EXPECT_GT(result.covariance.diagonal().minCoeff(), 0);
    }
    EXPECT_GE(result.total_ms, 0);
    EXPECT_EQ(result.state_hash, state_hash(result));
    if (result.is_key_frame) key_frames.push_back(i);
  }
  core.finish();

  // 21 degrees at 8 a key frame, 0.42 m at a tenth of the depth each
  ASSERT_EQ(core.key_frames().size(), key_frames.size());
  EXPECT_GE(key_frames.size(), 3u);
  EXPECT_LE(key_frames.size(), 10u);
  EXPECT_EQ(key_frames[0], 0);
  for (size_t k = 0; k < key_frames.size(); ++k) {
    const KeyFrameRecord& record = core.key_frames()[k];
    const StampedPose& pose = core.trajectory()[static_cast<size_t>(record.index)];
    EXPECT_EQ(record.index, key_frames[k]);
    EXPECT_EQ(record.stamp_ns, pose.stamp_ns);
    EXPECT_LT(distance_m(record.T_map_left, pose.T), 1e-9);
    ASSERT_TRUE(record.observations);
    EXPECT_GT(record.observations->size(), 60u);
    if (k > 0) {
      EXPECT_LE(record.index - key_frames[k - 1], 6) << "8 degrees are six frames";
    }
  }
  ASSERT_EQ(core.trajectory().size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(core.trajectory()[3].stamp_ns, room_.frame(3).stamp_ns);
}

TEST_P(Preset, ItsPointsLieOnTheWalls) {
  Pipeline core(room_.rig(), preset(GetParam()));
  for (int64_t i = 0; i < 13; ++i) core.process(room_.frame(i));
  core.finish();
  const std::vector<CloudPoint> cloud = core.cloud();
  ASSERT_GT(cloud.size(), 60u);
  // The map begins where the robot was: the room is 6 m x 5 m x 2.5 m about (1, 0.5).
  const Eigen::Vector3d low(-2, -2, 0), high(4, 3, 2.5);
  size_t on_a_wall = 0;
  for (const CloudPoint& point : cloud) {
    const double off =
        std::min((point.p_map - low).cwiseAbs().minCoeff(), (high - point.p_map).cwiseAbs().minCoeff());
    on_a_wall += off < 0.02 + 3 * point.sigma_m;
    EXPECT_GT(point.sigma_m, 0);
    EXPECT_LT(static_cast<size_t>(point.key_frame), core.key_frames().size());
  }
  EXPECT_GT(static_cast<double>(on_a_wall), 0.95 * static_cast<double>(cloud.size()));

  const OccupancyMap map = core.map();
  int lines_with_wall = 0;
  for (double y = -0.4; y < 0.9; y += 0.1) {
    float most = 0;
    for (double x = 3.8; x < 4.2; x += 0.05) most = std::max(most, map.at_point(x, y));
    lines_with_wall += most > OccupancyMap::kUnknown;
  }
  EXPECT_GE(lines_with_wall, 7) << "of 13 across the wall ahead";
  EXPECT_LT(map.at_point(2, 0.3), OccupancyMap::kUnknown);   // the floor before it
  EXPECT_EQ(map.at_point(-1.5, 0), OccupancyMap::kUnknown);  // behind the robot
  EXPECT_EQ(core.layers().size(), static_cast<size_t>(core.options().mapping.layer_count()));
  EXPECT_EQ(core.last_disparity().size(), cv::Size(160, 120));
}

/// Of two half-resolution disparity maps, where both know one [full-resolution px].
double median_difference_px(const cv::Mat& a, const cv::Mat& b) {
  std::vector<int> off;
  for (int v = 0; v < a.rows; ++v) {
    for (int u = 0; u < a.cols; ++u) {
      const int one = a.at<int16_t>(v, u), other = b.at<int16_t>(v, u);
      if (one >= 0 && other >= 0) off.push_back(std::abs(one - other));
    }
  }
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  return off[off.size() / 2] / 8.0;
}

class PipelineTest : public testing::Test {
 protected:
  const BoxRoom room_;
};

TEST_F(PipelineTest, TheFirstPoseIsTheCameraOnTheBody) {
  Pipeline core(room_.rig(), {});
  const FrameResult first = core.process(room_.frame(0));
  EXPECT_EQ(first.T_map_left.matrix(), room_.rig().T_body_left.matrix());
  EXPECT_TRUE(first.is_key_frame);
  for (const FeatureObservation& f : first.features) EXPECT_TRUE(f.is_new && f.has_right);
}

TEST_F(PipelineTest, FeaturesKeepTheirNumber) {
  Pipeline core(room_.rig(), {});
  FrameResult before = core.process(room_.frame(0));
  int64_t largest = before.features.back().id;
  for (int64_t i = 1; i < 6; ++i) {
    const FrameResult now = core.process(room_.frame(i));
    int64_t previous = -1;
    for (const FeatureObservation& f : now.features) {
      EXPECT_GT(f.id, previous);  // in order, none twice
      previous = f.id;
      if (f.is_new) {
        EXPECT_GT(f.id, largest);
      }
      if (f.is_new) {
        EXPECT_TRUE(now.is_key_frame);
      }
    }
    largest = std::max(largest, previous);
  }
}

TEST_F(PipelineTest, ABlackoutIsReportedWaitedForAndEnded) {
  SlamOptions options;
  options.tracking.hold_lost_s = 0.3;
  Pipeline core(room_.rig(), options);
  std::vector<TrackingStatus> statuses;
  std::vector<int> segments;
  for (int64_t i = 0; i < 12; ++i) {
    const bool dark = i >= 4 && i < 9;
    const FrameResult result = core.process(dark ? room_.dark_frame(i) : room_.frame(i));
    statuses.push_back(result.status);
    segments.push_back(result.segment);
    if (dark) {
      EXPECT_THAT(result.message, HasSubstr("12 needed")) << i;
    }
    if (!dark) {
      EXPECT_EQ(result.message, "") << i;
    }
    // The plan is exact: believing it while nothing is seen costs nothing.
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(static_cast<double>(i))), 0.02) << i;
  }
  EXPECT_THAT(statuses, ElementsAre(kStarted, kTracking, kTracking, kTracking, kLost, kLost, kLost, kLost,
                                    kLost, kStarted, kTracking, kTracking));
  EXPECT_THAT(segments, ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1));
  EXPECT_EQ(core.key_frames().back().segment, 1);
}

TEST_F(PipelineTest, AShortBlackoutIsBridgedWithinTheSegment) {
  SlamOptions options;
  options.tracking.hold_lost_s = 0.45;
  Pipeline core(room_.rig(), options);
  std::vector<TrackingStatus> statuses;
  for (int64_t i = 0; i < 8; ++i) {
    const FrameResult result = core.process(i == 4 || i == 5 ? room_.dark_frame(i) : room_.frame(i));
    statuses.push_back(result.status);
    EXPECT_EQ(result.segment, 0);
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(static_cast<double>(i))), 0.02) << i;
  }
  EXPECT_THAT(statuses,
              ElementsAre(kStarted, kTracking, kTracking, kTracking, kLost, kLost, kTracking, kTracking));
}

TEST_F(PipelineTest, ARepeatedPairIsCarriedByThePlan) {
  SlamOptions options;
  options.tracking.hold_lost_s = 0.3;  // two frames
  Pipeline core(room_.rig(), options);
  std::vector<TrackingStatus> statuses;
  StereoFrame last;
  for (int64_t i = 0; i < 12; ++i) {
    StereoFrame frame = room_.frame(i);
    const bool repeated = i == 3 || (i >= 6 && i < 9);
    if (repeated) {
      frame.left = last.left;
      frame.right = last.right;
    }
    const FrameResult result = core.process(frame);
    statuses.push_back(result.status);
    EXPECT_EQ(result.message, repeated ? "the images are those of the frame before" : "");
    EXPECT_EQ(result.segment, 0);
    EXPECT_EQ(result.features.empty(), repeated);
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(static_cast<double>(i))), 0.01) << i;
    last = frame;
  }
  EXPECT_THAT(statuses, ElementsAre(kStarted, kTracking, kTracking, kRepeated, kTracking, kTracking,
                                    kRepeated, kRepeated, kLost, kTracking, kTracking, kTracking));
  for (int64_t i = 0; i < 12; ++i) {
    const Pose truth = room_.T_map_left(static_cast<double>(i));
    EXPECT_LT(distance_m(core.trajectory()[static_cast<size_t>(i)].T, truth), 0.01) << i;
  }
}

TEST_F(PipelineTest, WithoutAPlanARepeatedPairIsWhereItWas) {
  Pipeline core(room_.rig(), {});
  StereoFrame frame;
  for (int64_t i = 0; i < 4; ++i) {
    const auto step = static_cast<double>(i);
    frame = room_.frame(i, step, step - 1, false);
    core.process(frame);
  }
  frame.index = 4;
  frame.stamp_ns = room_.frame(4).stamp_ns;
  const FrameResult result = core.process(frame);
  EXPECT_EQ(result.status, kTracking) << "the robot may have stopped";
  EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(3)), 0.01);
}

TEST_F(PipelineTest, ASlipOfTheRightImageIsFoundAndTakenBack) {
  constexpr int kSlip_px = 2;
  Pipeline core(room_.rig(), {}), paper(room_.rig(), preset("paper"));
  std::vector<TrackingStatus> statuses;
  int lost_by_paper = 0;
  for (int64_t i = 0; i < 12; ++i) {
    StereoFrame frame = room_.frame(i);
    if (i >= 4) {
      cv::Mat slipped = frame.right.clone();
      frame.right.rowRange(0, frame.right.rows - kSlip_px).copyTo(slipped.rowRange(kSlip_px, slipped.rows));
      frame.right = slipped;
    }
    const FrameResult result = core.process(frame);
    statuses.push_back(result.status);
    EXPECT_NEAR(result.row_offset_px, i < 7 ? 0 : kSlip_px, i < 7 ? 0 : 0.05) << i;
    EXPECT_EQ(result.message, i >= 4 && i < 7 ? "most matches are 2.0 px beside their rows" : "") << i;
    EXPECT_EQ(result.segment, 0);
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(static_cast<double>(i))), 0.02) << i;
    lost_by_paper += paper.process(frame).status == kLost;
  }
  EXPECT_THAT(statuses, ElementsAre(kStarted, kTracking, kTracking, kTracking, kLost, kLost, kLost, kTracking,
                                    kTracking, kTracking, kTracking, kTracking));
  EXPECT_EQ(lost_by_paper, 8) << "which is left as it was published";
}

TEST_F(PipelineTest, ALateRightImageIsFoundAndWhatHasFlowedByThenTakenOff) {
  constexpr double kLate_steps = 0.3, kLate_s = 0.04;
  Pipeline core(room_.rig(), {}), paper(room_.rig(), preset("paper"));
  double worst_m = 0, worst_of_paper_m = 0;
  for (int64_t i = 0; i < 20; ++i) {
    const auto step = static_cast<double>(i);
    const bool late = i >= 4 && i < 14;
    StereoFrame frame = room_.frame(i);
    if (late) frame.right = room_.frame(i, step + kLate_steps, step).right;
    const FrameResult result = core.process(frame);
    EXPECT_EQ(result.status, i == 0 ? kStarted : kTracking) << i << ": " << result.message;
    EXPECT_NEAR(result.right_late_s, late ? kLate_s : 0, late ? 0.006 : 0) << i;
    worst_m = std::max(worst_m, distance_m(result.T_map_left, room_.T_map_left(step)));
    const FrameResult published = paper.process(frame);
    EXPECT_EQ(published.right_late_s, 0);
    worst_of_paper_m = std::max(worst_of_paper_m, distance_m(published.T_map_left, room_.T_map_left(step)));
  }
  EXPECT_LT(worst_m, 0.01);
  EXPECT_GT(worst_of_paper_m, 3 * worst_m) << "which is left as it was published";
}

TEST_F(PipelineTest, TheDenseMapOfALateRightImageIsThatOfAPairTakenTogether) {
  constexpr double kLate_steps = 0.3;
  Pipeline core(room_.rig(), {});
  DenseDisparity in_time({}), as_they_came({});
  int compared = 0;
  for (int64_t i = 0; i < 14; ++i) {
    const auto step = static_cast<double>(i);
    StereoFrame frame = room_.frame(i);
    in_time.compute(frame.left, frame.right);
    if (i >= 4) frame.right = room_.frame(i, step + kLate_steps, step).right;
    as_they_came.compute(frame.left, frame.right);
    if (!core.process(frame).is_key_frame || i < 4) continue;
    ++compared;
    EXPECT_LT(median_difference_px(core.last_disparity(), in_time.half_resolution()), 0.15) << i;
    EXPECT_GT(median_difference_px(as_they_came.half_resolution(), in_time.half_resolution()), 0.6) << i;
  }
  EXPECT_GT(compared, 1);
}

TEST_F(PipelineTest, WhatIsBlownOutIsNotMissed) {
  // A flash: most features are in white, where nothing can be seen. Those that are left are few of all.
  constexpr double kFlash = 2;
  Pipeline core(room_.rig(), {});
  for (int64_t i = 0; i < 8; ++i) {
    StereoFrame frame = room_.frame(i);
    if (i == 4) {
      frame.left *= kFlash;
      frame.right *= kFlash;
    }
    const FrameResult result = core.process(frame);
    if (i == 4) {
      EXPECT_LT(result.inliers, 40);
    }
    EXPECT_EQ(result.status, i == 0 ? kStarted : kTracking) << i << ": " << result.message;
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(static_cast<double>(i))), 0.02) << i;
  }
}

TEST_F(PipelineTest, StartsWhenThereIsSomethingToSee) {
  Pipeline core(room_.rig(), {});
  const FrameResult dark = core.process(room_.dark_frame(0));
  EXPECT_EQ(dark.status, kLost);
  EXPECT_EQ(dark.message, "0 features found in both images, 12 needed to start");
  EXPECT_EQ(core.process(room_.dark_frame(1)).status, kLost);
  const FrameResult started = core.process(room_.frame(2));
  EXPECT_EQ(started.status, kStarted);
  EXPECT_LT(distance_m(started.T_map_left, room_.T_map_left(2)), 1e-9);  // where the plan has brought it
  EXPECT_EQ(core.process(room_.frame(3)).status, kTracking);
  ASSERT_EQ(core.trajectory().size(), 4u);
  EXPECT_EQ(core.key_frames().front().index, 2);
}

TEST_F(PipelineTest, APlannedLeapIsFollowed) {
  // 12 degrees and a quarter of a metre between two pictures; the plan says so.
  Pipeline core(room_.rig(), {});
  core.process(room_.frame(0));
  const FrameResult leap = core.process(room_.frame(1, 8, 0));
  ASSERT_EQ(leap.status, kTracking) << leap.message;
  EXPECT_LT(distance_m(leap.T_map_left, room_.T_map_left(8)), 0.02);
  EXPECT_GT(leap.features_tracked, 40);
}

TEST_F(PipelineTest, WithoutAPlanTheMotionGoesOn) {
  Pipeline core(room_.rig(), {});
  for (int64_t i = 0; i < 10; ++i) {
    const auto step = static_cast<double>(i);
    const FrameResult result = core.process(room_.frame(i, step, step - 1, false));
    EXPECT_EQ(result.status, i == 0 ? kStarted : kTracking) << i;
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(step)), 0.02) << i;
  }
  // In the dark it goes on at constant velocity.
  StereoFrame dark = room_.dark_frame(10);
  dark.T_previous_left.reset();
  const FrameResult result = core.process(dark);
  EXPECT_EQ(result.status, kLost);
  EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(10)), 0.02);
}

TEST_F(PipelineTest, AWrongPlanIsOverruled) {
  // Standing still is planned, turning happens: the image says more than the plan.
  Pipeline core(room_.rig(), {});
  for (int64_t i = 0; i < 6; ++i) {
    StereoFrame frame = room_.frame(i, 2.0 * static_cast<double>(i), 0);
    frame.T_previous_left = Pose::Identity();
    const FrameResult result = core.process(frame);
    EXPECT_EQ(result.status, i == 0 ? kStarted : kTracking) << i << ": " << result.message;
    EXPECT_LT(distance_m(result.T_map_left, room_.T_map_left(2.0 * static_cast<double>(i))), 0.03) << i;
  }
}

std::string complaint(Pipeline& core, const StereoFrame& frame) {
  try {
    core.process(frame);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST_F(PipelineTest, RefusesImagesOfAnotherKind) {
  Pipeline core(room_.rig(), {});
  const StereoFrame good = room_.frame(0);
  const std::string expected = "frame 0: wanted two 8-bit grey images of 320 x 240 px";
  StereoFrame frame = good;
  frame.right = cv::Mat::zeros(240, 319, CV_8UC1);
  EXPECT_EQ(complaint(core, frame), expected);
  frame.right = cv::Mat::zeros(240, 320, CV_8UC3);
  EXPECT_EQ(complaint(core, frame), expected);
  frame = good;
  frame.left = cv::Mat::zeros(240, 320, CV_16UC1);
  EXPECT_EQ(complaint(core, frame), expected);
  frame.left = cv::Mat();
  EXPECT_EQ(complaint(core, frame), expected);
  // A refusal leaves no trace.
  EXPECT_EQ(core.process(good).status, kStarted);
}

TEST_F(PipelineTest, TwoCoresAgreeBitByBit) {
  Pipeline a(room_.rig(), {}), b(room_.rig(), {});
  for (int64_t i = 0; i < 8; ++i) {
    const StereoFrame frame = i == 5 ? room_.dark_frame(i) : room_.frame(i);
    EXPECT_EQ(a.process(frame).state_hash, b.process(frame).state_hash) << i;
  }
  a.finish(), b.finish();
  EXPECT_EQ(a.map().value, b.map().value);
  ASSERT_EQ(a.cloud().size(), b.cloud().size());
  for (size_t i = 0; i < a.cloud().size(); ++i) EXPECT_EQ(a.cloud()[i].p_map, b.cloud()[i].p_map);
}

TEST_F(PipelineTest, OtherImagesGiveAnotherHash) {
  Pipeline a(room_.rig(), {}), b(room_.rig(), {});
  EXPECT_NE(a.process(room_.frame(0)).state_hash, b.process(room_.frame(0, 0.01, 0)).state_hash);
}

TEST(StateHash, DependsOnWhatTheCoreCarriesOnAndOnNothingElse) {
  FrameResult result;
  result.features = {{4, 1, 2, 3, 4, true, false, true}};
  const uint64_t hash = state_hash(result);
  FrameResult same = result;
  same.total_ms = 12;
  same.stage_ms[2] = 3;
  same.message = "late";
  EXPECT_EQ(state_hash(same), hash);
  FrameResult other = result;
  other.T_map_left.translation().x() = 1e-300;
  EXPECT_NE(state_hash(other), hash);
  other = result;
  other.features[0].u_right_px += 1e-6F;
  EXPECT_NE(state_hash(other), hash);
  other = result;
  other.status = kLost;
  EXPECT_NE(state_hash(other), hash);
}

}  // namespace
}  // namespace groundloop::slam
