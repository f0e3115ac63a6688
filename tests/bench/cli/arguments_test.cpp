#include "bench/cli/arguments.h"

#include <gtest/gtest.h>

namespace groundloop::bench {
namespace {

template <class Parse>
std::string message_of(Parse parse) {
  try {
    parse();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Seeds, OneOrARange) {
  EXPECT_EQ(parse_seeds("7").first, 7u);
  EXPECT_EQ(parse_seeds("7").last, 7u);
  EXPECT_EQ(parse_seeds("3..12").first, 3u);
  EXPECT_EQ(parse_seeds("3..12").last, 12u);
  EXPECT_EQ(parse_seeds("18446744073709551614").last, 18446744073709551614u);
}

TEST(Seeds, AnythingElseIsRefused) {
  for (const std::string text : {"", "x", "1..", "..2", "2..1", "1..2..3", "-1", "1.5", "1 "}) {
    EXPECT_EQ(
        message_of([&] { parse_seeds(text); }),
        "--seed" + (text.empty() ? "" : ": " + text) + ": wanted a whole number, or A..B with A at most B");
  }
}

TEST(Stages, AreNamed) {
  EXPECT_TRUE(parse_stages({}).empty());
  EXPECT_EQ(parse_stages({"stereo", "tracking"}),
            (OracleStages{slam::OracleStage::kTracking, slam::OracleStage::kStereo}));
  EXPECT_EQ(name_of(parse_stages({"stereo", "tracking"})), "tracking+stereo");
  EXPECT_EQ(message_of([] {
              parse_stages({"tracking", "depth"});
            }),
            "--oracle: depth: wanted one of: tracking, stereo, motion, loops");
}

TEST(Override, SplitsAtTheFirstEqualsSign) {
  EXPECT_EQ(parse_override("plan.speed_mps=0.3").key, "plan.speed_mps");
  EXPECT_EQ(parse_override("plan.speed_mps=0.3").value, "0.3");
  EXPECT_EQ(parse_override("a=b=c").value, "b=c");
  EXPECT_EQ(parse_override("a=").value, "");
}

TEST(Override, NeedsAKeyAndAnEqualsSign) {
  EXPECT_EQ(message_of([] { parse_override("speed"); }),
            "--set: speed: wanted key=value, such as slam.preset=paper");
  EXPECT_EQ(message_of([] { parse_override("=3"); }),
            "--set: =3: wanted key=value, such as slam.preset=paper");
}

}  // namespace
}  // namespace groundloop::bench
