#include "bench/metrics/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace groundloop::bench {
namespace {

TEST(Statistics, OfFourNumbers) {
  const Statistics s = statistics({4, 1, 2, 3});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.min, 1);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(s.sse, 30);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));  // of the population: divided by 4
}

TEST(Statistics, MedianOfAnOddCountIsTheMiddleOne) { EXPECT_EQ(statistics({9, 1, 5}).median, 5); }

TEST(Statistics, OfOneNumber) {
  const Statistics s = statistics({3});
  EXPECT_EQ(s.std, 0);
  EXPECT_EQ(s.median, 3);
  EXPECT_EQ(s.rmse, 3);
}

TEST(Statistics, OfNothingIsAnError) { EXPECT_THROW(statistics({}), std::invalid_argument); }

}  // namespace
}  // namespace groundloop::bench
