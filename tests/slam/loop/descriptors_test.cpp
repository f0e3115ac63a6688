#include "slam/loop/descriptors.h"

#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>

#include "tests/slam/loop/painted_room.h"

namespace groundloop::slam {
namespace {

Descriptor random_descriptor(uint64_t seed) {
  return {random_bits(seed, 0, 0), random_bits(seed, 0, 1), random_bits(seed, 0, 2), random_bits(seed, 0, 3)};
}

Descriptor flipped(Descriptor descriptor, int bits) {
  for (int bit = 0; bit < bits; ++bit) {
    const int place = 7 * bit % 256;
    descriptor[static_cast<size_t>(place / 64)] ^= uint64_t{1} << (place % 64);
  }
  return descriptor;
}

TEST(Descriptors, DistanceCountsBits) {
  const Descriptor a = random_descriptor(1);
  for (const int bits : {0, 1, 64, 200, 256}) EXPECT_EQ(distance(a, flipped(a, bits)), bits);
}

TEST(Descriptors, MatchesAreMutualAndUnambiguous) {
  const auto keypoint = [](const Descriptor& descriptor) { return Keypoint{{0, 0, 0}, descriptor}; };
  const Descriptor p = random_descriptor(1), q = random_descriptor(2), r = random_descriptor(3);
  std::vector<DescriptorMatch> matches;
  const std::vector<Keypoint> a = {keypoint(p), keypoint(q), keypoint(flipped(p, 10))};
  // p has a near one; q has two that are as near as each other; r is alone
  const std::vector<Keypoint> b = {keypoint(flipped(q, 20)), keypoint(flipped(p, 3)), keypoint(r),
                                   keypoint(flipped(q, 21))};
  match_descriptors(a, b, 64, 0.8, matches);
  ASSERT_EQ(matches.size(), 1U);  // the copy of p in a is nearest to the same one in b, but not the reverse
  EXPECT_EQ(matches[0].a, 0);
  EXPECT_EQ(matches[0].b, 1);
  match_descriptors(a, b, 2, 0.8, matches);
  EXPECT_TRUE(matches.empty());
  match_descriptors(a, {}, 64, 0.8, matches);
  EXPECT_TRUE(matches.empty());
}

TEST(Describer, FindsCornersAllOverTheImageWithTheirDepth) {
  const PaintedRoom room(5);
  const LoopKeyFrame frame = room.key_frame(0, PaintedRoom::T_room_left(0, 0, 90));
  std::vector<Keypoint> found;
  Describer(200).describe(frame.left, frame.half_disparity, found);
  EXPECT_GE(found.size(), 120U);
  EXPECT_LE(found.size(), 200U);
  int quarter[4] = {};
  int right_depth = 0;
  for (const Keypoint& keypoint : found) {
    ++quarter[(keypoint.uvu_px.x() > 160 ? 1 : 0) + (keypoint.uvu_px.y() > 120 ? 2 : 0)];
    // the wall straight ahead is 3 m away, and nothing in the image is farther
    const double z_m = PaintedRoom::rig().triangulate(keypoint.uvu_px.cast<double>())->z();
    if (z_m < 3.15) ++right_depth;
  }
  for (const int count : quarter) EXPECT_GT(count, 20);
  EXPECT_GT(right_depth, 0.9 * static_cast<double>(found.size()));
}

TEST(Describer, DoesNotDependOnThreads) {
  const PaintedRoom room(5);
  const LoopKeyFrame frame = room.key_frame(0, PaintedRoom::T_room_left(1, 0, 60));
  const int threads = cv::getNumThreads();
  std::vector<std::vector<Keypoint>> answers;
  for (const int count : {1, 4, 4}) {
    cv::setNumThreads(count);
    answers.emplace_back();
    Describer(300).describe(frame.left, frame.half_disparity, answers.back());
  }
  cv::setNumThreads(threads);
  ASSERT_FALSE(answers[0].empty());
  for (const auto& answer : answers) {
    ASSERT_EQ(answer.size(), answers[0].size());
    for (size_t i = 0; i < answer.size(); ++i) {
      EXPECT_EQ(answer[i].uvu_px, answers[0][i].uvu_px);
      EXPECT_EQ(answer[i].descriptor, answers[0][i].descriptor);
    }
  }
}

TEST(Describer, SaysNothingOfAnEmptyPicture) {
  const cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(128)), unknown(120, 160, CV_16SC1, cv::Scalar(-16));
  std::vector<Keypoint> found(3);
  Describer(200).describe(grey, unknown, found);
  EXPECT_TRUE(found.empty());
  const PaintedRoom room(5);
  Describer(200).describe(room.key_frame(0, PaintedRoom::T_room_left(0, 0, 90)).left, unknown, found);
  EXPECT_TRUE(found.empty());
}

TEST(StoredView, OfAnOrdinaryKeyFrameTakesLessThan400Kilobytes) {
  StoredView view;
  view.grey.create(480, 640, CV_8UC1);
  view.landmarks.resize(460);
  view.keypoints.resize(400);
  EXPECT_LT(view.bytes(), 400000U);
}

}  // namespace
}  // namespace groundloop::slam
