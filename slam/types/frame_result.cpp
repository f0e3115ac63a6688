#include "slam/types/frame_result.h"

namespace groundloop::slam {

const char* name_of(TrackingStatus status) {
  switch (status) {
    case TrackingStatus::kNotRun:
      return "not_run";
    case TrackingStatus::kStarted:
      return "started";
    case TrackingStatus::kTracking:
      return "tracking";
    case TrackingStatus::kRepeated:
      return "repeated";
    case TrackingStatus::kLost:
      return "lost";
  }
  return "?";
}

const char* name_of(Stage stage) {
  constexpr std::array<const char*, kStageCount> kNames = {"pyramid",    "tracking",  "registration",
                                                           "detection",  "disparity", "stereo",
                                                           "adjustment", "loop",      "mapping"};
  return kNames.at(static_cast<size_t>(stage));
}

}  // namespace groundloop::slam
