#pragma once

#include <string>
#include <vector>

#include "slam/features/affine_klt.h"
#include "slam/features/detector.h"
#include "slam/mapping/flog_options.h"
#include "slam/registration/registration.h"
#include "slam/stereo/disparity.h"
#include "slam/stereo/matcher.h"
#include "slam/tracking/tracker.h"
#include "slam/types/config.h"

namespace groundloop::slam {

/// When a frame becomes a key frame: as soon as one of these holds. Section 2.1 of the paper: a compromise
/// between how often pose and map are updated and the work that this takes.
struct KeyFrameOptions {
  double max_translation_ratio =
      0.1;                         ///< motion since the last key frame, relative to the median depth there
  double max_rotation_deg = 8;     ///< motion since the last key frame
  double min_tracked_ratio = 0.6;  ///< agreeing features, relative to those of the last key frame
  int max_interval_frames = 30;

  template <class Archive>
  void visit(Archive& a) {
    a("max_translation_ratio", max_translation_ratio, {.min = 0.001, .max = 10});
    a("max_rotation_deg", max_rotation_deg, {.min = 0.1, .max = 180});
    a("min_tracked_ratio", min_tracked_ratio, {.min = 0, .max = 1});
    a("max_interval_frames", max_interval_frames, {.min = 1, .max = 100000});
  }
};

/// Points of the dense disparity map that join the features' in the occupancy map. YAML: slam.dense_map
struct DenseMapOptions {
  int step_px = 8;      ///< distance of the points in the image; 0: features only, as in the paper
  double weight = 0.3;  ///< trust in one such point, between 0 and 1

  template <class Archive>
  void visit(Archive& a) {
    a("step_px", step_px, {.min = 0, .max = 1000});
    a("weight", weight, {.min = 0, .max = 1});
  }
};

/// Every option of the core; YAML keys equal member names (`slam: {set: {tracking.max_features: 400}}`).
struct SlamOptions {
  uint64_t seed = 1;  ///< of the sampling in registration
  TrackingOptions tracking;
  KltOptions klt;
  DetectionOptions detection;
  DisparityOptions disparity;
  StereoOptions stereo;
  RegistrationOptions registration;
  KeyFrameOptions key_frame;
  FlogOptions mapping;
  DenseMapOptions dense_map;

  template <class Archive>
  void visit(Archive& a) {
    a("seed", seed);
    a("tracking", tracking);
    a("klt", klt);
    a("detection", detection);
    a("disparity", disparity);
    a("stereo", stereo);
    a("registration", registration);
    a("key_frame", key_frame);
    a("mapping", mapping);
    a("dense_map", dense_map);
  }
};

/// Names of the presets, in the order in which help shows them.
std::vector<std::string> preset_names();

/// @param name "paper" (the faithful method) or "default" (the best this project has)
/// @throws InputError naming the presets
SlamOptions preset(const std::string& name);

}  // namespace groundloop::slam
