#include "slam/loop/loop_verifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <numbers>

#include "tests/slam/loop/painted_room.h"

namespace groundloop::slam {
namespace {

using ::testing::HasSubstr;
constexpr double kDegree = std::numbers::pi / 180;

/// From a known place, 2.2 m before the far wall, looking at it at an angle.
const Pose kHere = PaintedRoom::T_room_left(0, 0.8, 70);

Pose moved(double right_m, double down_m, double forward_m, double pitch_deg, double yaw_deg,
           double roll_deg) {
  Pose T = Pose::Identity();
  T.translation() << right_m, down_m, forward_m;
  T.linear() = so3_exp({pitch_deg * kDegree, yaw_deg * kDegree, roll_deg * kDegree});
  return T;
}

PosePrediction prediction_of(const Pose& T_from_to, double sigma_m, double sigma_deg) {
  PosePrediction prediction{T_from_to, Matrix6d::Zero()};
  prediction.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  prediction.covariance.diagonal().tail<3>().setConstant(std::pow(sigma_deg * kDegree, 2));
  return prediction;
}

/// A key frame of kHere, and a later one at T_from_to from there.
struct ComeBack {
  CurrentView stored, current;
};
ComeBack come_back(const Pose& T_from_to) {
  const PaintedRoom room(1);
  return {current_view(room.key_frame(10, kHere)), current_view(room.key_frame(200, kHere * T_from_to))};
}

Vector6d error_of(const Verification& found, const Pose& T_from_to) {
  return se3_log(T_from_to.inverse() * found.link.T_from_to);
}

struct Revisit {
  const char* name;
  Pose T_from_to;
  Light light = {1, 0, 1.5, 0};
};

class Revisits : public ::testing::TestWithParam<Revisit> {};

TEST_P(Revisits, AreFoundAndMeasured) {
  const PaintedRoom room(1);
  const CurrentView stored = current_view(room.key_frame(10, kHere));
  const CurrentView current =
      current_view(room.key_frame(200, kHere * GetParam().T_from_to, GetParam().light));
  LoopVerifier verifier = make_verifier();
  const Verification found = verifier.verify(stored.view, current, std::nullopt, 1);
  ASSERT_TRUE(found.accepted) << found.message;
  EXPECT_EQ(found.link.kind, LinkKind::kLandmarks);
  EXPECT_EQ(found.link.from_index, 10);
  EXPECT_EQ(found.link.to_index, 200);
  const Vector6d error = error_of(found, GetParam().T_from_to);
  EXPECT_LT(error.head<3>().norm(), 0.010);
  EXPECT_LT(error.tail<3>().norm(), 0.3 * kDegree);
  EXPECT_LT(found.link.residual_px, 0.6);

  // The same from a prediction that is off by its own uncertainty.
  const Pose T_predicted = GetParam().T_from_to * moved(0.02, 0, -0.02, 0.1, 0.3, 0.1);
  const Verification again = verifier.verify(stored.view, current, prediction_of(T_predicted, 0.02, 0.3), 1);
  ASSERT_TRUE(again.accepted) << again.message;
  EXPECT_LT(error_of(again, GetParam().T_from_to).head<3>().norm(), 0.010);
}

TEST(LoopVerifier, ALateRightImageMeasuresAsOneInTime) {
  const PaintedRoom room(1);
  Vector6d velocity;
  velocity << 0.02, -0.01, 0.3, 0.03, 0.5, -0.02;
  const RightLag lag(velocity, 0.05);
  const CurrentView stored = current_view(room.key_frame(10, kHere));
  const Pose T_from_to = moved(0.15, 0, 0.2, 0, 4, 0), T_room_left = kHere * T_from_to;
  const CurrentView in_time = current_view(room.key_frame(200, T_room_left));
  CurrentView late = in_time;
  late.right.build(room.key_frame(200, T_room_left * lag.T_late_left().inverse()).right, KltOptions{}.levels);
  LoopVerifier verifier = make_verifier();
  const auto verify = [&](const CurrentView& current) {
    return verifier.verify(stored.view, current, prediction_of(T_from_to, 0.02, 0.3), 1);
  };
  EXPECT_FALSE(verify(late).accepted);
  late.right_lag = lag;
  const Verification best = verify(in_time), found = verify(late);
  ASSERT_TRUE(found.accepted) << found.message;
  EXPECT_GT(found.link.inliers, 0.9 * best.link.inliers);
  EXPECT_LT(error_of(found, T_from_to).head<3>().norm(), 0.006);
  EXPECT_LT(error_of(found, T_from_to).tail<3>().norm(), 0.2 * kDegree);
}

INSTANTIATE_TEST_SUITE_P(Loop, Revisits,
                         ::testing::Values(Revisit{"SamePlace", Pose::Identity()},
                                           Revisit{"HalfAMetreAside", moved(0.5, 0, 0, 0, -8, 0)},
                                           Revisit{"Turned30Degrees", moved(-0.3, 0, 0.1, 0, 30, 0)},
                                           Revisit{"Nearer", moved(0.1, 0, 0.5, 0, 5, 0)},
                                           Revisit{"FartherAndHigher", moved(0, -0.2, -0.5, -5, 0, 0)},
                                           Revisit{"Rolled", moved(0.05, 0, 0, 0, 0, 25)},
                                           Revisit{"Darker", moved(0.1, 0, 0.1, 0, 3, 0), {0.6, 10, 1.5, 0}},
                                           Revisit{
                                               "Brighter", moved(0.1, 0, 0.1, 0, -3, 0), {1.2, 15, 1.5, 0}}),
                         [](const auto& revisit) { return std::string(revisit.param.name); });

TEST(LoopVerifier, ItsErrorIsWithinItsCovariance) {
  const PaintedRoom room(2);
  const CurrentView stored = current_view(room.key_frame(10, kHere));
  LoopVerifier verifier = make_verifier();
  double nees = 0;
  int links = 0;
  for (uint64_t k = 0; k < 12; ++k) {
    const auto within = [k](uint64_t stream, double reach) {
      return reach * (2 * uniform(9, stream, k) - 1);
    };
    const Pose T =
        moved(within(0, 0.3), within(1, 0.1), within(2, 0.3), within(3, 4), within(4, 12), within(5, 4));
    const CurrentView current = current_view(room.key_frame(100 + static_cast<int64_t>(k), kHere * T));
    const Verification found = verifier.verify(stored.view, current, std::nullopt, k);
    if (!found.accepted) continue;
    ++links;
    const Vector6d error = error_of(found, T);
    nees += error.dot(found.link.covariance.inverse() * error);
  }
  EXPECT_EQ(links, 12);
  // 6 when exact. Above: the 0.1 % bound of chi-square with 72 degrees of freedom. Below: a standard
  // deviation that is at most 2.5 times too large, since misfits are taken for what they would be if nothing
  // explained them and these clean pictures have few other errors.
  EXPECT_LT(nees / links, 9.2);
  EXPECT_GT(nees / links, 1);
}

/// With 24 landmarks spread over the image, where 30 are needed.
TEST(LoopVerifier, FewLandmarksWillDoWhereAPlaceThatWasOutOfSightIsExpected) {
  const Pose T_from_to = moved(0.1, 0, 0.1, 0, 2, 0);
  auto [stored, current] = come_back(T_from_to);
  std::vector<Landmark> few;
  const size_t stride = stored.view.landmarks.size() / 24;
  for (size_t i = 0; few.size() < 24; ++i) few.push_back(stored.view.landmarks[i * stride]);
  stored.view.landmarks = few;
  const PosePrediction near = prediction_of(T_from_to * moved(0.01, 0, 0, 0, 0.1, 0), 0.01, 0.1);
  const PosePrediction off = prediction_of(T_from_to * moved(0, 0, 0.15, 0, 0, 0), 0.01, 0.1);
  LoopVerifier verifier = make_verifier();

  EXPECT_THAT(verifier.verify(stored.view, current, std::nullopt, 1).message,
              HasSubstr("landmarks agree, 30 needed"));
  EXPECT_THAT(verifier.verify(stored.view, current, near, 1).message, HasSubstr("landmarks agree, 30 needed"))
      << "it was in sight all the time";

  stored.view.was_away = true;
  const Verification found = verifier.verify(stored.view, current, near, 1);
  ASSERT_TRUE(found.accepted) << found.message;
  EXPECT_LT(error_of(found, T_from_to).head<3>().norm(), 0.015);
  const Verification contradicted = verifier.verify(stored.view, current, off, 1);
  EXPECT_FALSE(contradicted.accepted);
  EXPECT_THAT(contradicted.message, HasSubstr("sigma from the predicted pose"));

  LoopOptions strict;
  strict.predicted_ease = 1;
  EXPECT_FALSE(make_verifier(strict).verify(stored.view, current, near, 1).accepted);
}

TEST(LoopVerifier, LooksForLandmarksThatBothViewsShare) {
  const Pose T_from_to = moved(0, 0, 0, 0, 25, 0);  // half of the stored picture is out of sight
  const ComeBack views = come_back(T_from_to);
  const auto expected = [&](int landmarks) {
    LoopOptions options;
    options.landmarks = landmarks;
    return make_verifier(options)
        .verify(views.stored.view, views.current, prediction_of(T_from_to, 0.01, 0.1), 1)
        .expected;
  };
  const int all = expected(5000);
  ASSERT_LT(all, 0.6 * static_cast<double>(views.stored.view.landmarks.size()));
  EXPECT_EQ(expected(static_cast<int>(1.5 * all)), all) << "those out of sight take no room";
  EXPECT_LE(expected(all / 2), all / 2);
  EXPECT_GT(expected(all / 2), all / 4);
}

TEST(LoopVerifier, AnExpectedPlaceMayBeMeasuredLessPrecisely) {
  const Pose T_from_to = moved(0.1, 0, 0.1, 0, 2, 0);
  auto [stored, current] = come_back(T_from_to);
  const PosePrediction near = prediction_of(T_from_to, 0.01, 0.1);
  const Verification precise = make_verifier().verify(stored.view, current, near, 1);
  ASSERT_TRUE(precise.accepted) << precise.message;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_rotation(
      precise.link.covariance.bottomRightCorner<3, 3>());

  LoopOptions options;  // twice as strict as the link is precise
  options.max_sigma_deg = std::sqrt(of_rotation.eigenvalues().z()) / kDegree / 2;
  options.predicted_ease = 0.4;
  EXPECT_THAT(make_verifier(options).verify(stored.view, current, near, 1).message,
              HasSubstr("uncertain by"));
  stored.view.was_away = true;
  const Verification found = make_verifier(options).verify(stored.view, current, near, 1);
  EXPECT_TRUE(found.accepted) << found.message;
}

/// Landmarks in the middle of the image alone: whether the camera turned or moved aside is hard to tell.
TEST(LoopVerifier, WhatFewLandmarksLeaveOpenIsTakenAsPredicted) {
  const Pose T_from_to = moved(0.1, 0, 0.1, 0, 2, 0);
  ComeBack views = come_back(T_from_to);
  std::erase_if(views.stored.view.landmarks, [](const Landmark& landmark) {
    return std::abs(landmark.uv_px.x() - 320) > 100 || std::abs(landmark.uv_px.y() - 240) > 100;
  });
  views.stored.view.was_away = true;
  LoopOptions options;
  options.min_cells = 1;
  options.predicted_ease = 0.1;
  options.max_sigma_deg = options.max_sigma_ratio = 0.3;
  options.margin_m = 0.1;
  options.margin_deg = 1;
  const auto error_with = [&](int min_inliers) {
    LoopOptions with = options;
    with.min_inliers = min_inliers;
    const Verification found = make_verifier(with).verify(views.stored.view, views.current,
                                                          prediction_of(T_from_to, 0.001, 0.01), 1);
    EXPECT_TRUE(found.accepted) << found.message;
    return error_of(found, T_from_to);
  };
  const Vector6d measured = error_with(6);    // enough agree: it stands as it was measured
  const Vector6d filled_in = error_with(60);  // too few, were the place not expected
  EXPECT_LT(filled_in.norm(), 0.8 * measured.norm());
  EXPECT_GT(filled_in.norm(), 0) << "the landmarks have a say";
}

TEST(LoopVerifier, WhatWasInSightAllTheTimeHasToTellMoreThanOdometry) {
  const Pose T_from_to = moved(0.1, 0, 0.1, 0, 2, 0);
  auto [stored, current] = come_back(T_from_to);
  LoopVerifier verifier = make_verifier();
  const PosePrediction rough = prediction_of(T_from_to, 0.01, 0.1),
                       exact = prediction_of(T_from_to, 1e-6, 1e-5);
  EXPECT_TRUE(verifier.verify(stored.view, current, rough, 1).accepted);
  EXPECT_EQ(verifier.verify(stored.view, current, exact, 1).message, "tells less than odometry does");
  stored.view.was_away = true;
  EXPECT_TRUE(verifier.verify(stored.view, current, exact, 1).accepted);
}

TEST(LoopVerifier, SeesNoLinkToWhatIsBehind) {
  const PaintedRoom room(1);
  const CurrentView stored = current_view(room.key_frame(10, kHere));
  LoopVerifier verifier = make_verifier();
  for (const double yaw_deg : {180.0, 250.0, 300.0}) {
    const Pose T_room_left = PaintedRoom::T_room_left(0, 0.8, yaw_deg);
    const CurrentView current = current_view(room.key_frame(200, T_room_left));
    const Verification unpredicted = verifier.verify(stored.view, current, std::nullopt, 1);
    EXPECT_FALSE(unpredicted.accepted);
    EXPECT_THAT(unpredicted.message, HasSubstr("descriptors: "));
    const Verification predicted =
        verifier.verify(stored.view, current, prediction_of(kHere.inverse() * T_room_left, 0.02, 0.3), 1);
    EXPECT_FALSE(predicted.accepted);
  }
}

TEST(LoopVerifier, IsNotDeceivedByACopyOfAPicture) {
  // The same picture hangs at two places; what is around it differs.
  const PaintedRoom room(3, {.period_m = 0, .posters = {{-5, 3, 1.2}, {5, 3, 1.2}}});
  const CurrentView stored = current_view(room.key_frame(10, PaintedRoom::T_room_left(-5, 0.8, 90)));
  const CurrentView copy = current_view(room.key_frame(200, PaintedRoom::T_room_left(5.1, 0.9, 90)));
  const CurrentView same = current_view(room.key_frame(200, PaintedRoom::T_room_left(-4.9, 0.9, 90)));
  LoopOptions options;
  options.min_inliers = 20;  // as many as the picture alone gives
  LoopVerifier verifier = make_verifier(options);
  EXPECT_TRUE(verifier.verify(stored.view, same, std::nullopt, 1).accepted);
  const Verification found = verifier.verify(stored.view, copy, std::nullopt, 1);
  EXPECT_FALSE(found.accepted);
  EXPECT_GE(found.link.inliers, options.min_inliers)
      << "the picture itself must have been found for this to be a test";
  EXPECT_THAT(found.message, HasSubstr("stored landmarks found, 45 % needed"));
  // What is around the picture now was not there then: that alone would do.
  LoopOptions reverse_only = options;
  reverse_only.min_inlier_ratio = 0;
  reverse_only.min_reverse_ratio = 0.7;
  EXPECT_THAT(make_verifier(reverse_only).verify(stored.view, copy, std::nullopt, 1).message,
              HasSubstr("of the current landmarks found in the stored view, 70 % needed"));
}

TEST(LoopVerifier, RefusesWhatContradictsThePrediction) {
  // A corridor that repeats every 4 m looks exactly the same one period on; only the prediction tells.
  const PaintedRoom corridor(4, {.period_m = 4, .posters = {}});
  const CurrentView stored = current_view(corridor.key_frame(10, PaintedRoom::T_room_left(-3, 0.8, 70)));
  const Pose T_room_copy = PaintedRoom::T_room_left(1.1, 0.8, 70);
  const CurrentView copy = current_view(corridor.key_frame(200, T_room_copy));
  LoopVerifier verifier = make_verifier();
  const Pose T_from_to = PaintedRoom::T_room_left(-3, 0.8, 70).inverse() * T_room_copy;
  EXPECT_TRUE(verifier.verify(stored.view, copy, std::nullopt, 1).accepted);
  const Verification found = verifier.verify(stored.view, copy, prediction_of(T_from_to, 0.3, 2), 1);
  EXPECT_FALSE(found.accepted);
  EXPECT_THAT(found.message, HasSubstr("sigma from the predicted pose, 4.5 allowed"));
}

TEST(LoopVerifier, SaysWhatIsMissing) {
  const PaintedRoom room(1);
  const CurrentView stored = current_view(room.key_frame(10, kHere));
  const CurrentView current = current_view(room.key_frame(200, kHere * moved(0.4, 0, 0.3, 0, 15, 10)));
  const auto message = [&](const LoopOptions& options) {
    return make_verifier(options).verify(stored.view, current, std::nullopt, 1).message;
  };
  LoopOptions options;
  EXPECT_EQ(message(options), "");
  options.min_inliers = 1000;
  EXPECT_THAT(message(options), HasSubstr("landmarks agree, 1000 needed"));
  options = {};
  options.min_inlier_ratio = 1;
  EXPECT_THAT(message(options), HasSubstr("stored landmarks found, 100 % needed"));
  options = {};
  options.min_cells = 48;
  EXPECT_THAT(message(options), HasSubstr("of 48 parts of the image, 48 needed"));
  options = {};
  options.max_sigma_ratio = 1e-5;
  EXPECT_THAT(message(options), HasSubstr("uncertain by"));
}

TEST(LoopVerifier, LooksAtNothingInAnEmptyView) {
  const PaintedRoom room(1);
  const CurrentView current = current_view(room.key_frame(200, kHere));
  StoredView empty;
  empty.grey = cv::Mat(240, 320, CV_8UC1, cv::Scalar(128));
  LoopVerifier verifier = make_verifier();
  EXPECT_FALSE(verifier.verify(empty, current, std::nullopt, 1).accepted);
  EXPECT_FALSE(verifier.verify(empty, current, prediction_of(Pose::Identity(), 0.01, 0.1), 1).accepted);
}

TEST(PredictedShape, IsTheDerivativeOfThePictureOfAFacingSurface) {
  const StereoRig rig = PaintedRoom::rig();
  const Pose T_to_from = moved(0.3, -0.1, 0.2, 5, -20, 10);
  const Eigen::Vector3d p(0.4, -0.3, 2);
  const Eigen::Vector3d n = p.normalized();
  for (const double offset_m : {0.0, rig.baseline_m}) {
    // the pixel (u, v) meets the plane n.x = n.p and is seen from the other camera
    const auto other = [&](const Eigen::Vector2d& uv) -> Eigen::Vector2d {
      const Eigen::Vector3d ray((uv.x() - rig.cx_px) / rig.fx_px, (uv.y() - rig.cy_px) / rig.fy_px, 1);
      Eigen::Vector3d q = T_to_from * (ray * (n.dot(p) / n.dot(ray)));
      q.x() -= offset_m;
      return {rig.fx_px * q.x() / q.z() + rig.cx_px, rig.fy_px * q.y() / q.z() + rig.cy_px};
    };
    const Eigen::Matrix2d A = predicted_shape(rig, T_to_from, p, offset_m);
    const Eigen::Vector2d uv = rig.project(p).head<2>();
    constexpr double kStep_px = 1e-4;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep_px * Eigen::Vector2d::Unit(k);
      const Eigen::Vector2d slope = (other(uv + step) - other(uv - step)) / (2 * kStep_px);
      EXPECT_LT((A.col(k) - slope).norm(), 1e-7);
    }
  }
}

}  // namespace
}  // namespace groundloop::slam
