#include "slam/stereo/disparity.h"

#include <gtest/gtest.h>

#include "slam/stereo/on_time_view.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/stereo/late_pair.h"

namespace groundloop::slam {
namespace {

const cv::Size kSize(480, 240);

/// Random dots of 2 x 2 px, a function of their place alone.
int dot(int x, int y) {
  const auto key = [](int i) { return static_cast<uint64_t>(i / 2 + 10000); };
  return static_cast<int>(random_index(random_bits(1, key(x), key(y)), 216)) + 20;
}

struct Dots {
  cv::Mat left, right;
};

/// A wall at `far_px`, and before it a board over the columns [first, last) of the left image at `near_px`.
Dots dots(int far_px, int near_px = 0, int first = 0, int last = 0) {
  const auto on_board = [&](int left_u) { return left_u >= first && left_u < last; };
  Dots pair;
  pair.left = draw(kSize, {}, [&](int u, int v) { return on_board(u) ? dot(u + 5000, v) : dot(u, v); });
  pair.right = draw(kSize, {}, [&](int u, int v) {
    return on_board(u + near_px) ? dot(u + near_px + 5000, v) : dot(u + far_px, v);
  });
  return pair;
}

TEST(DenseDisparity, AWallHasItsDisparityEverywhere) {
  for (const int disparity_px : {6, 24, 60, 100}) {
    const Dots pair = dots(disparity_px);
    DenseDisparity dense({});
    dense.compute(pair.left, pair.right);
    int known = 0, asked = 0;
    for (int v = 15; v < kSize.height - 15; v += 7) {
      for (int u = disparity_px + 16; u < kSize.width - 16; u += 7) {
        const auto found = dense.around(static_cast<float>(u), static_cast<float>(v));
        ++asked;
        if (!found) continue;
        ++known;
        EXPECT_NEAR(*found, disparity_px, 1) << "at " << u << ", " << v;
      }
    }
    EXPECT_GT(known, 0.98 * asked) << disparity_px;
  }
}

TEST(DenseDisparity, TheLeftColumnsAreSearchedAsFarAsTheyGo) {
  // Left of the search width (128 px), where a matcher that wants all of it would know nothing.
  const Dots pair = dots(20);
  DenseDisparity dense({});
  dense.compute(pair.left, pair.right);
  for (int u = 36; u < 128; u += 4) {
    const auto found = dense.around(static_cast<float>(u), 120);
    ASSERT_TRUE(found) << u;
    EXPECT_NEAR(*found, 20, 1) << u;
  }
}

TEST(DenseDisparity, NothingMatchesOutsideTheRightImage) {
  const Dots pair = dots(60);
  DenseDisparity dense({});
  dense.compute(pair.left, pair.right);
  const cv::Mat& map = dense.half_resolution();
  ASSERT_EQ(map.size(), cv::Size(240, 120));
  ASSERT_EQ(map.type(), CV_16SC1);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) EXPECT_LE(map.at<int16_t>(v, u), 16 * u);
  }
}

TEST(DenseDisparity, TwoSurfacesHaveTheirOwn) {
  const Dots pair = dots(16, 48, 200, 340);
  DenseDisparity dense({});
  dense.compute(pair.left, pair.right);
  for (int v = 20; v < 220; v += 10) {
    const auto at = [&](int u) {
      return dense.around(static_cast<float>(u), static_cast<float>(v)).value_or(-1);
    };
    for (int u = 225; u < 315; u += 10) EXPECT_NEAR(at(u), 48, 1) << u;
    for (int u = 365; u < 460; u += 10) EXPECT_NEAR(at(u), 16, 1) << u;
    for (int u = 40; u < 140; u += 10) EXPECT_NEAR(at(u), 16, 1) << u;  // and the wall left of what is hidden
  }
}

TEST(DenseDisparity, NothingIsKnownOfAFlatWall) {
  const cv::Mat flat(kSize, CV_8UC1, cv::Scalar(150));
  DenseDisparity dense({});
  dense.compute(flat, flat);
  for (float u = 0; u < 480; u += 13) EXPECT_FALSE(dense.around(u, 100)) << u;
}

TEST(DenseDisparity, NothingIsKnownOfAFlatPartOfATexturedWall) {
  Dots pair = dots(24);
  pair.left(cv::Rect(200, 60, 160, 120)).setTo(128);
  pair.right(cv::Rect(200 - 24, 60, 160, 120)).setTo(128);
  DenseDisparity dense({});
  dense.compute(pair.left, pair.right);
  EXPECT_FALSE(dense.around(280, 120));
  EXPECT_TRUE(dense.around(420, 120));
}

TEST(DenseDisparity, AskingOutsideIsNoAnswer) {
  const Dots pair = dots(24);
  DenseDisparity dense({});
  EXPECT_FALSE(dense.around(100, 100));  // nothing was computed
  dense.compute(pair.left, pair.right);
  for (const auto& [u, v] :
       {std::pair{-50.0F, 100.0F}, {900.0F, 100.0F}, {200.0F, -60.0F}, {200.0F, 600.0F}}) {
    EXPECT_FALSE(dense.around(u, v)) << u << ", " << v;
  }
}

TEST(DenseDisparity, TheSearchWidthBoundsWhatIsFound) {
  DisparityOptions options;
  options.max_disparity_px = 64;
  DenseDisparity dense(options);
  const Dots pair = dots(100);
  dense.compute(pair.left, pair.right);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 240; ++u) EXPECT_LT(dense.half_resolution().at<int16_t>(v, u), 32 * 16);
  }
}

TEST(DisparityOptions, SayWhatTheMatcherCannotDo) {
  DisparityOptions options;
  std::vector<Problem> problems;
  set_by_key(options, "max_disparity_px", YAML::Node(100), "--set", 0, problems);
  set_by_key(options, "window_px", YAML::Node(10), "--set", 0, problems);
  ASSERT_GE(problems.size(), 2u);
  EXPECT_EQ(problems[0].text(), "--set: max_disparity_px: 100: wanted a multiple of 32");
  EXPECT_EQ(problems.back().text(), "--set: window_px: 10: wanted an odd number");
}

struct MapErrors {
  int known = 0;
  double off_px = 0;  ///< median
};
MapErrors errors_of(const LatePair& pair, const DenseDisparity& dense) {
  std::vector<double> off_px;
  for (int v = 20; v < pair.rig.height_px - 20; v += 5) {
    for (int u = 60; u < pair.rig.width_px - 40; u += 5) {
      const auto found = dense.around(static_cast<float>(u), static_cast<float>(v));
      if (found) off_px.push_back(std::abs(*found - pair.disparity_px(u, v)));
    }
  }
  std::sort(off_px.begin(), off_px.end());
  return {static_cast<int>(off_px.size()), off_px[off_px.size() / 2]};
}

TEST(DenseDisparity, OfALateRightImageIsThatOfAPairTakenTogether) {
  DenseDisparity dense({});
  const LatePair in_time(0);
  dense.compute(in_time.left, in_time.right);
  const MapErrors best = errors_of(in_time, dense);
  for (const double late_s : {0.05, -0.03}) {
    const LatePair pair(late_s);
    dense.compute(pair.left, pair.right);
    const MapErrors untold = errors_of(pair, dense);
    EXPECT_GT(untold.off_px, 4);
    const OnTimeView view(pair.rig, pair.lag, 1.5);
    dense.compute(pair.left, pair.right, &view);
    const MapErrors told = errors_of(pair, dense);
    EXPECT_LT(told.off_px, best.off_px + 0.05) << late_s;
    EXPECT_GT(told.known, 0.95 * best.known) << late_s;
  }
}

TEST(DenseDisparity, NothingMatchesOutsideALateRightImage) {
  const LatePair pair;  // by whose time its left border has lost what was there
  DenseDisparity dense({});
  const OnTimeView view(pair.rig, pair.lag, 1.5);
  dense.compute(pair.left, pair.right, &view);
  const cv::Mat& map = dense.half_resolution();
  int known = 0;
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < 60; ++u) {
      const double u_px = 2 * u + 0.5, v_px = 2 * v + 0.5, disparity_px = map.at<int16_t>(v, u) / 8.0;
      const auto p_left = pair.rig.triangulate({u_px, v_px, u_px - disparity_px});
      if (disparity_px < 0 || !p_left) continue;
      ++known;
      EXPECT_GT(pair.rig.project(pair.lag.T_late_left() * *p_left).z(), -0.6) << u << ", " << v;
    }
  }
  EXPECT_GT(known, 3000);
}

}  // namespace
}  // namespace groundloop::slam
