#include "sim/faults/head_faults.h"

#include <gtest/gtest.h>

#include <numbers>

namespace groundloop::sim {
namespace {

Fault knock(double pan_deg, double tilt_deg, double roll_deg) {
  Fault fault;
  fault.at_s = 1;
  fault.knock = KnockFault{pan_deg, tilt_deg, roll_deg};
  return fault;
}

TEST(HeadFaults, AKnockTurnsTheRightCameraAsItsKeysSay) {
  const double c = std::cos(10 * std::numbers::pi / 180), s = std::sin(10 * std::numbers::pi / 180);
  // columns: where the camera's x (right), y (down) and z (forward) axes point to
  const Eigen::Matrix3d panned = T_calibrated_right({knock(10, 0, 0)}, 1).linear();
  EXPECT_TRUE(panned.col(2).isApprox(Eigen::Vector3d(-s, 0, c), 1e-12)) << "forward turns to the left";
  const Eigen::Matrix3d tilted = T_calibrated_right({knock(0, 10, 0)}, 1).linear();
  EXPECT_TRUE(tilted.col(2).isApprox(Eigen::Vector3d(0, -s, c), 1e-12)) << "forward turns up";
  const Eigen::Matrix3d rolled = T_calibrated_right({knock(0, 0, 10)}, 1).linear();
  EXPECT_TRUE(rolled.col(0).isApprox(Eigen::Vector3d(c, s, 0), 1e-12)) << "the right side goes down";
  EXPECT_EQ(T_calibrated_right({knock(10, 0, 0)}, 1).translation().norm(), 0) << "about its own centre";
}

TEST(HeadFaults, AKnockStaysAndKnocksAddUp) {
  EXPECT_TRUE(T_calibrated_right({knock(1, 0, 0)}, 0.999).isApprox(slam::Pose::Identity()));
  EXPECT_TRUE(T_calibrated_right({knock(1, 0, 0)}, 1e4)
                  .isApprox(T_calibrated_right({knock(0.4, 0, 0), knock(0.6, 0, 0)}, 1)));
}

TEST(HeadFaults, TriggerOffsetsAddUpWhileTheyLast) {
  Fault early, later;
  early.at_s = 1;
  early.for_s = 2;
  early.trigger_offset = TriggerOffsetFault{0.01};
  later.at_s = 2;
  later.for_s = 2;
  later.trigger_offset = TriggerOffsetFault{-0.03};
  EXPECT_EQ(trigger_offset_s({early, later}, 0.5), 0);
  EXPECT_EQ(trigger_offset_s({early, later}, 1), 0.01);
  EXPECT_NEAR(trigger_offset_s({early, later}, 2.5), -0.02, 1e-15);
  EXPECT_EQ(trigger_offset_s({early, later}, 3), -0.03);
  EXPECT_EQ(trigger_offset_s({early, later}, 4), 0) << "over at its end";
}

}  // namespace
}  // namespace groundloop::sim
