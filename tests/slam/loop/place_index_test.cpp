#include "slam/loop/place_index.h"

#include <gtest/gtest.h>

#include "slam/loop/descriptors.h"
#include "slam/types/counter_random.h"

namespace groundloop::slam {
namespace {

constexpr int kDescriptors = 300;

std::vector<Keypoint> random_view(uint64_t seed) {
  std::vector<Keypoint> view(kDescriptors);
  for (size_t i = 0; i < view.size(); ++i) {
    for (size_t k = 0; k < 4; ++k) view[i].descriptor[k] = random_bits(seed, i, k);
  }
  return view;
}

/// A view of the same place: a share of the descriptors again, with some bits flipped; the rest is new.
std::vector<Keypoint> seen_again(const std::vector<Keypoint>& view, double share, int flips, uint64_t seed) {
  std::vector<Keypoint> again = random_view(seed);
  for (size_t i = 0; i < static_cast<size_t>(share * kDescriptors); ++i) {
    again[i] = view[i];
    for (int f = 0; f < flips; ++f) {
      const uint32_t bit = random_index(random_bits(seed, 1000 + i, static_cast<uint64_t>(f)), 256);
      again[i].descriptor[bit / 64] ^= uint64_t{1} << (bit % 64);
    }
  }
  return again;
}

TEST(PlaceIndex, FindsThePlaceOfWhichAFifthIsSeenAgain) {
  PlaceIndex index;
  for (uint64_t view = 0; view < 100; ++view) index.add(random_view(view));
  std::vector<PlaceCandidate> found;
  for (const uint64_t view : {3, 42, 99}) {
    index.query(seen_again(random_view(view), 0.2, 30, 1000 + view), 100, 3, found);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].view, static_cast<int>(view));
    for (size_t i = 1; i < found.size(); ++i) EXPECT_GT(found[0].score, 5 * found[i].score);
  }
}

TEST(PlaceIndex, AsksOnlyTheViewsItIsToldTo) {
  PlaceIndex index;
  for (uint64_t view = 0; view < 10; ++view) index.add(random_view(view));
  std::vector<PlaceCandidate> found;
  index.query(random_view(7), 8, 3, found);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].view, 7);
  index.query(random_view(7), 7, 3, found);
  for (const PlaceCandidate& candidate : found) EXPECT_LT(candidate.view, 7);
}

TEST(PlaceIndex, WhatEveryViewHasSaysLittle) {
  // All views share two thirds of their descriptors; the rest tells them apart.
  const std::vector<Keypoint> common = random_view(77);
  PlaceIndex index;
  std::vector<std::vector<Keypoint>> views;
  for (uint64_t view = 0; view < 50; ++view) {
    views.push_back(seen_again(common, 0.67, 0, view));
    index.add(views.back());
  }
  std::vector<PlaceCandidate> found;
  index.query(views[20], 50, 50, found);
  ASSERT_GE(found.size(), 2U);
  EXPECT_EQ(found[0].view, 20);
  // 200 descriptors of weight log 2 and 100 of weight log 51 against the 200 alone
  EXPECT_GT(found[0].score, 3 * found[1].score);
}

TEST(PlaceIndex, AnswersNothingToNothing) {
  PlaceIndex index;
  std::vector<PlaceCandidate> found = {{1, 1}};
  index.query(random_view(1), 0, 3, found);
  EXPECT_TRUE(found.empty());
  index.add({});
  index.query(random_view(1), 1, 3, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace groundloop::slam
