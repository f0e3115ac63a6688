#pragma once

#include <cstdint>

#include "sim/scenario/camera_plan.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// Where the camera really sits, seen from where it is believed to sit.
slam::Pose hand_eye_error(const HandEyeError& error);

/// How far the hand comes to rest from where it was sent, in its own frame: normal along and about every
/// axis, drawn by (seed, stop) alone.
slam::Pose repeatability_error(const ArmErrors& errors, uint64_t seed, int64_t stop);

}  // namespace groundloop::sim
