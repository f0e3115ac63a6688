#include "slam/source/text.h"

#include <gtest/gtest.h>

namespace groundloop::slam {
namespace {

TEST(SecondsToNs, MovesDigitsExactly) {
  EXPECT_EQ(seconds_to_ns("0"), 0);
  EXPECT_EQ(seconds_to_ns("1"), 1000000000);
  EXPECT_EQ(seconds_to_ns("0.000000001"), 1);
  EXPECT_EQ(seconds_to_ns("2.077025"), 2077025000);
  EXPECT_EQ(seconds_to_ns("1.000000e-01"), 100000000);
  EXPECT_EQ(seconds_to_ns("4.5E+2"), 450000000000);
  EXPECT_EQ(seconds_to_ns(".5"), 500000000);
  EXPECT_EQ(seconds_to_ns("7."), 7000000000);
  EXPECT_EQ(seconds_to_ns("+3.25"), 3250000000);
  EXPECT_EQ(seconds_to_ns("-98.449999872"), -98449999872);
}

TEST(SecondsToNs, KeepsWhatADoubleWouldRound) {
  EXPECT_EQ(seconds_to_ns("1403715273.262142976"), 1403715273262142976);
  EXPECT_EQ(seconds_to_ns("9223372036.854775806"), 9223372036854775806);
}

TEST(SecondsToNs, RoundsBelowANanosecondHalfAwayFromZero) {
  EXPECT_EQ(seconds_to_ns("0.0000000014"), 1);
  EXPECT_EQ(seconds_to_ns("0.0000000015"), 2);
  EXPECT_EQ(seconds_to_ns("-0.0000000015"), -2);
  EXPECT_EQ(seconds_to_ns("5e-10"), 1);
  EXPECT_EQ(seconds_to_ns("4e-10"), 0);
  EXPECT_EQ(seconds_to_ns("9e-30"), 0);
}

TEST(SecondsToNs, RefusesWhatIsNoTime) {
  for (const char* text :
       {"", "-", ".", "e5", "1.2.3", "12s", "nan", "1e", "1e5.5", "0x10", "1e999", "9223372037", " 1"}) {
    EXPECT_FALSE(seconds_to_ns(text)) << text;
  }
}

TEST(Numbers, TheWholeTextMustBeANumber) {
  EXPECT_EQ(to_double("-3.798145000000e+02"), -379.8145);
  EXPECT_EQ(to_double("+2"), 2.0);
  EXPECT_EQ(to_int64("1403715273262142976"), 1403715273262142976);
  for (const char* text : {"", "x", "1x", "--1", "+-1", "1 "}) {
    EXPECT_FALSE(to_double(text)) << text;
    EXPECT_FALSE(to_int64(text)) << text;
  }
}

TEST(Split, LeavesOutEmptyParts) {
  using Parts = std::vector<std::string_view>;
  EXPECT_EQ(split("a, b,,c", ", "), (Parts{"a", "b", "c"}));
  EXPECT_EQ(split("  one\t", " \t"), Parts{"one"});
  EXPECT_EQ(split("", " "), Parts{});
  EXPECT_EQ(split("  ", " "), Parts{});
}

}  // namespace
}  // namespace groundloop::slam
