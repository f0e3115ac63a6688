#include "bench/report/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "bench/report/canvas.h"
#include "bench/report/plate.h"
#include "bench/report/preview.h"
#include "tests/bench/report/synthetic_run.h"

namespace groundloop::bench {
namespace {

bool is_near(const cv::Vec3b& a, const cv::Vec3b& b, int tolerance) {
  return std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
         std::abs(a[2] - b[2]) <= tolerance;
}

int count_near(const cv::Mat& image, Colour colour, int tolerance = 12) {
  int count = 0;
  for (auto it = image.begin<cv::Vec3b>(); it != image.end<cv::Vec3b>(); ++it) {
    count += is_near(*it, colour.bgr(), tolerance) ? 1 : 0;
  }
  return count;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PlanView, KeepsOneScaleAndPutsNorthUp) {
  const PlanView view({{-1, -2}, {9, 3}}, {50, 20}, 1000, 800);
  EXPECT_DOUBLE_EQ(view.px_per_m(), 100);
  EXPECT_EQ(view(-1, 3), cv::Point2d(50, 20));
  EXPECT_EQ(view(9, -2), cv::Point2d(1050, 520));
  EXPECT_TRUE(view.metres(150, 120).isApprox(Eigen::Vector2d(0, 2)));
}

TEST(PlanView, CentresATallScene) {
  const PlanView view({{0, 0}, {1, 10}}, {0, 0}, 1000, 500);
  EXPECT_DOUBLE_EQ(view.px_per_m(), 50);
  EXPECT_EQ(view(0.5, 10), cv::Point2d(500, 0));
}

TEST(NiceStep, IsOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(nice_step_above(0.7), 1);
  EXPECT_DOUBLE_EQ(nice_step_above(1.2), 2);
  EXPECT_DOUBLE_EQ(nice_step_above(0.021), 0.05);
  EXPECT_DOUBLE_EQ(nice_step_above(60), 100);
  EXPECT_EQ(tick_text(-1e-17, 0.05), "0.00");
  EXPECT_EQ(tick_text(40, 20), "40");
}

TEST(DrawTracked, MarksEachKindInItsColour) {
  const cv::Mat image =
      draw_tracked(SyntheticRun::left_image(), SyntheticRun::features(), SyntheticRun::history());
  EXPECT_EQ(image.cols, 1280);
  EXPECT_EQ(image.type(), CV_8UC3);
  // rings, squares and crosses are hollow or thin: the mark of feature 1 (inlier, at (72, 30)) has radius 5
  // px
  const cv::Point2d inlier((72 + 0.5) * 2, (30 + 0.5) * 2);
  const cv::Vec3b on_ring = image.at<cv::Vec3b>(cvRound(inlier.y), cvRound(inlier.x + 7));
  EXPECT_GT(on_ring[1], 180);
  EXPECT_LT(on_ring[2], 120);
  const cv::Mat none = draw_tracked(SyntheticRun::left_image(), {});
  EXPECT_GT(count_near(image, Colour(0xff4b5c)), count_near(none, Colour(0xff4b5c)) + 100);
  EXPECT_GT(count_near(image, Colour(0xffc83d)), count_near(none, Colour(0xffc83d)) + 100);
  EXPECT_GT(count_near(image, Colour(0x4aa8ff)), 100) << "tails";
  EXPECT_TRUE(equal(
      image, draw_tracked(SyntheticRun::left_image(), SyntheticRun::features(), SyntheticRun::history())));
}

TEST(DrawDisparity, UnknownIsDarkAndNearIsRed) {
  const cv::Mat image = draw_disparity(SyntheticRun::disparity(), SyntheticRun::rig());
  const cv::Vec3b unknown = image.at<cv::Vec3b>(480, 100), far = image.at<cv::Vec3b>(5, 800),
                  near = image.at<cv::Vec3b>(950, 800);
  EXPECT_LT(unknown[0] + unknown[1] + unknown[2], 120);
  EXPECT_GT(far[0], far[2] + 50);
  EXPECT_GT(near[2], near[0] + 50);
}

TEST(DrawDisparity, ABlindPictureIsAllDark) {
  const cv::Mat blind(240, 320, CV_16SC1, cv::Scalar(-16));
  const cv::Mat image = draw_disparity(blind, SyntheticRun::rig());
  EXPECT_TRUE(is_near(image.at<cv::Vec3b>(480, 640), Colour(0x14181f).bgr(), 2));
}

TEST(DrawTopView, ShowsTheEstimateWhereItIs) {
  TopView view;
  view.outline = {{"floor", {{0, 0}, {10, 0}, {10, 6}, {0, 6}}}};
  for (int i = 0; i <= 10; ++i) {
    slam::Pose T = slam::StereoRig::level_camera({2 + 0.6 * i, 3, 0.3});
    view.estimate.push_back({i, T});
  }
  const cv::Mat image = draw_top_view(view);
  EXPECT_EQ(image.cols, 1600);
  // the line is at half the height of the scene, the only red of the picture outside the legend
  int top = image.rows, bottom = 0;
  for (int v = 0; v < image.rows - 60; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      if (!is_near(image.at<cv::Vec3b>(v, u), palette::kEstimate.bgr(), 10)) continue;
      top = std::min(top, v);
      bottom = std::max(bottom, v);
    }
  }
  const double middle = 22 + (image.rows - 22 - 84) / 2.0;
  EXPECT_NEAR(top, middle, 3);
  EXPECT_NEAR(bottom, middle, 3);
}

TEST(DrawTopView, DrawsLinksFromPlaceToPlace) {
  TopView view;
  view.outline = {{"floor", {{0, 0}, {10, 0}, {10, 6}, {0, 6}}}};
  const auto coloured = [&view](Colour colour) {
    const cv::Mat image = draw_top_view(view);
    int pixels = 0;
    for (int v = 0; v < image.rows - 60; ++v) {
      for (int u = 0; u < image.cols; ++u) pixels += is_near(image.at<cv::Vec3b>(v, u), colour.bgr(), 40);
    }
    return pixels;
  };
  EXPECT_EQ(coloured(palette::kLink), 0);
  view.links = {{{1, 3, 0}, {9, 3, 0}, false}};
  EXPECT_GT(coloured(palette::kLink), 900);  // 8 of the 10 m that fill 1400 px
  EXPECT_EQ(coloured(palette::kEstimate), 0);
  view.links[0].wrong = true;
  EXPECT_GT(coloured(palette::kEstimate), 900);
  EXPECT_EQ(coloured(palette::kLink), 0);
}

TEST(DrawTopView, IsTheSameTwiceAndNeedsNothing) {
  TopView view;
  EXPECT_EQ(draw_top_view(view).cols, 1600);
  view.outline = SyntheticRun::outline();
  for (int i = 0; i < SyntheticRun::kFrames; ++i) {
    view.truth.push_back({i, SyntheticRun::T_world_left(i)});
    view.key_frames.push_back(SyntheticRun::T_world_left(i));
    view.cloud.push_back(
        {Eigen::Vector3f(0.03F * static_cast<float>(i), 1, 0.01F * static_cast<float>(i)), 0.1F});
  }
  EXPECT_TRUE(equal(draw_top_view(view), draw_top_view(view)));
}

TEST(DrawTopView, FarPointsDoNotShrinkTheScene) {
  TopView view;
  view.estimate = {{0, slam::Pose::Identity()}};
  for (int i = 0; i < 1000; ++i) {
    const auto a = static_cast<float>(i) * 0.1F;
    view.cloud.push_back({Eigen::Vector3f(5 * std::cos(a), 5 * std::sin(a), 1), 0.05F});
  }
  const cv::Mat without = draw_top_view(view);
  view.cloud[0].p = {5000, 5000, 1};
  EXPECT_EQ(draw_top_view(view).size(), without.size());
}

TEST(ResampledMap, UndoesTheRotationOfTheMap) {
  const auto exact = SyntheticRun::exact_map();
  const auto moved =
      resampled_map(SyntheticRun::estimated_map(), SyntheticRun::T_world_map(), exact.geometry);
  for (int row = 0; row < exact.geometry.rows; ++row) {
    for (int col = 0; col < exact.geometry.cols; ++col) {
      const Eigen::Vector2d p = exact.geometry.centre_m(col, row);
      const bool inside = p.x() > 0 && p.x() < 12 && p.y() > 0 && p.y() < 8;
      if (!inside) continue;
      ASSERT_EQ(moved.at(col, row), exact.at(col, row)) << "at " << p.transpose();
    }
  }
  EXPECT_EQ(moved.at(0, 0), slam::OccupancyMap::kUnknown);
}

TEST(DrawMaps, ShowTheirCellsToScale) {
  slam::OccupancyMap map{{0.1, 0, 0, 100, 50}, std::vector<float>(5000, 0.0F)};
  for (int row = 10; row < 30; ++row) {
    for (int col = 20; col < 60; ++col) map.value[map.geometry.index(col, row)] = 1;
  }
  const cv::Mat pair = draw_map_pair(map, map);
  // each panel is 708 px for 10.6 m; the block covers 4 m x 2 m of both
  const double px_per_m = 708 / 10.6;
  EXPECT_NEAR(count_near(pair, Colour(0x16202c), 4), 2 * 8 * px_per_m * px_per_m, 2500);
}

TEST(DrawMaps, UndecidedCellsOnlyLean) {
  const auto colour_of = [](float value) {
    const slam::OccupancyMap map{{0.1, 0, 0, 100, 10}, std::vector<float>(1000, value)};
    return draw_map_pair(map, map).at<cv::Vec3b>(100, 300)[1];
  };
  EXPECT_GT(colour_of(0.0F), colour_of(0.4F) + 20);
  EXPECT_GT(colour_of(0.4F), colour_of(0.5F));
  EXPECT_GT(colour_of(0.5F), colour_of(0.6F));
  EXPECT_GT(colour_of(0.6F), colour_of(1.0F) + 50);
}

TEST(DrawMaps, DifferencesAreCountedWhereVisible) {
  slam::OccupancyMap exact{{0.1, 0, 0, 100, 50}, std::vector<float>(5000, 0.0F)};
  slam::OccupancyMap estimate = exact;
  std::vector<uint8_t> visible(5000, 1);
  for (int row = 0; row < 50; ++row) {
    for (int col = 0; col < 20; ++col) estimate.value[exact.geometry.index(col, row)] = 1;  // false occupied
    for (int col = 20; col < 30; ++col) visible[exact.geometry.index(col, row)] = 0;
    for (int col = 30; col < 40; ++col) estimate.value[exact.geometry.index(col, row)] = 0.5F;  // missed
  }
  const cv::Mat image = draw_map_difference(estimate, exact, visible);
  const double px2_per_m2 = std::pow(1500 / 10.6, 2);
  EXPECT_NEAR(count_near(image, Colour(0xe0334a), 2) / px2_per_m2, 10, 0.2);
  EXPECT_NEAR(count_near(image, Colour(0x7fa8e8), 2) / px2_per_m2, 5, 0.2);

  visible.pop_back();
  EXPECT_THROW(draw_map_difference(estimate, exact, visible), std::invalid_argument);
}

TEST(DrawPreview, WorksFromAStartAlone) {
  EXPECT_EQ(draw_preview({}, {}, {1, 2, 0}).cols, 1600);
  const cv::Mat image = draw_preview(SyntheticRun::outline(), {{1, 1, 0}, {11, 1, 0}}, {1, 1, 0});
  EXPECT_GT(count_near(image, Colour(0x1f5fd0)), 1000);
}

/// Paths whose camera looks aside, as an arm's may, show where to.
TEST(DrawPreview, ShowsWhereTheCameraLooksWhenThatIsNotTheWay) {
  const auto path_looking = [](double yaw_rad) {
    std::vector<PlanPose> path;
    for (int i = 0; i <= 100; ++i) path.push_back({1 + 0.1 * i, 1, yaw_rad});
    return draw_preview(SyntheticRun::outline(), path, path.front());
  };
  const int ahead = count_near(path_looking(0), Colour(0x1f5fd0)),
            aside = count_near(path_looking(M_PI / 2), Colour(0x1f5fd0));
  EXPECT_GT(aside, ahead + 500);
}

/// In a room of 10 m, drawn 1500 px wide or a little less.
TEST(DrawPreview, ShowsWhoWalksWhatIsMovedAndWhereTheRobotIsCarried) {
  constexpr Colour kPathAfter(0x16a0a0), kPerson(0x8a3ab9), kMoved(0xd9730d), kKidnapped(0xd6246e);
  const std::vector<Footprint> room = {{"floor", {{0, 0}, {10, 0}, {10, 5}, {0, 5}}}};
  const std::vector<PlanPose> path = {{1, 1, 0}, {3, 1, 0}};
  const cv::Mat plain = draw_preview(room, path, path.front());
  for (const Colour colour : {kPathAfter, kPerson, kMoved, kKidnapped})
    EXPECT_EQ(count_near(plain, colour), 0);

  DrawnEvents events;
  events.people.push_back({"anna", {{5, 1}, {9, 1}}, true});
  const Footprint chair{"chair", {{1, 3}, {2, 3}, {2, 4}, {1, 4}}};
  const Footprint there{"chair", {{7, 3}, {8, 3}, {8, 4}, {7, 4}}};
  events.moves.push_back({12, {chair}, {there}});
  events.kidnappings.push_back({28, path.back(), {{3, 4.5, 0}, {9, 4.5, 0}}});
  const cv::Mat image = draw_preview(room, path, path.front(), events);
  // dashes of 9 px in 15, and 2.5 px wide, of which at least one pixel has the full colour
  EXPECT_GT(count_near(image, kPerson), 4 * 140 * 9 / 15);
  EXPECT_GT(count_near(image, kMoved), 5 * 140 * 9 / 15);
  EXPECT_GT(count_near(image, kKidnapped), 3.5 * 140 * 9 / 15);
  // the way goes on where the robot was put down: 6 m more
  EXPECT_GT(count_near(image, kPathAfter), 6 * 140);
}

TEST(DrawPlate, PicturesOfARowHaveOneHeightAndFillTheWidth) {
  const cv::Mat red(100, 200, CV_8UC3, cv::Scalar(0, 0, 255)), blue(300, 300, CV_8UC3, cv::Scalar(255, 0, 0));
  const cv::Mat grey(50, 100, CV_8UC1, cv::Scalar(100));
  const cv::Mat plate = draw_plate({{{"a", red}, {"b", blue}}, {{"c", grey}}});
  EXPECT_EQ(plate.cols, 1600);
  EXPECT_EQ(plate.type(), CV_8UC3);
  // 1600 - 2 * 16 - 20 = 1548 for two pictures, twice and once as wide as high: 516 px high; less half a
  // frame's line
  EXPECT_NEAR(count_near(plate, Colour(0xff0000), 4), (1032 - 3) * (516 - 3), 800);
  EXPECT_NEAR(count_near(plate, Colour(0x0000ff), 4), (516 - 3) * (516 - 3), 800);
  EXPECT_NEAR(count_near(plate, Colour(0x646464), 2), (1568 - 3) * (784 - 3), 800);
}

TEST(DrawPlate, AMissingPictureIsAnError) {
  EXPECT_THROW(draw_plate({{{"nothing", cv::Mat()}}}), std::invalid_argument);
  EXPECT_THROW(draw_plate({{}}), std::invalid_argument);
}

}  // namespace
}  // namespace groundloop::bench
