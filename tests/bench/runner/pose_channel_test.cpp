#include "bench/runner/pose_channel.h"

#include <gtest/gtest.h>

#include <thread>

namespace groundloop::bench {
namespace {

slam::Pose at_x(double x_m) {
  slam::Pose T = slam::Pose::Identity();
  T.translation().x() = x_m;
  return T;
}

TEST(PoseChannel, GivesEveryPairItsOwnPoseWhenItIsKnown) {
  PoseChannel channel;
  std::optional<slam::Pose> second;
  std::thread waiting([&] { second = channel.wait(1); });
  channel.put(at_x(1));
  channel.put(at_x(2));
  waiting.join();
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->translation().x(), 2);
  EXPECT_EQ(channel.wait(0)->translation().x(), 1) << "as often as asked";
}

TEST(PoseChannel, ALostPairHasNone) {
  PoseChannel channel;
  channel.put(std::nullopt);
  EXPECT_FALSE(channel.wait(0).has_value());
}

TEST(PoseChannel, ClosingItEndsTheWaiting) {
  PoseChannel channel;
  channel.put(at_x(1));
  std::optional<slam::Pose> never = at_x(9);
  std::thread waiting([&] { never = channel.wait(5); });
  channel.close();
  waiting.join();
  EXPECT_FALSE(never.has_value());
  EXPECT_TRUE(channel.wait(0).has_value()) << "what is known stays known";
}

}  // namespace
}  // namespace groundloop::bench
