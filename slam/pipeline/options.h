#pragma once

#include <string>
#include <vector>

#include "slam/adjustment/adjustment_problem.h"
#include "slam/features/affine_klt.h"
#include "slam/features/detector.h"
#include "slam/loop/loop_options.h"
#include "slam/mapping/flog_options.h"
#include "slam/mapping/map_match_options.h"
#include "slam/registration/registration.h"
#include "slam/stereo/dense_points.h"
#include "slam/stereo/disparity.h"
#include "slam/stereo/matcher.h"
#include "slam/tracking/tracker.h"
#include "slam/types/config.h"

namespace groundloop::slam {

/// When a frame becomes a key frame: as soon as one of these holds. Section 2.1 of the paper: a compromise
/// between how often pose and map are updated and the work that this takes.
struct KeyFrameOptions {
  double max_translation_ratio =
      0.1;                          ///< motion since the last key frame, relative to the median depth there
  double max_rotation_deg = 8;      ///< motion since the last key frame
  double min_tracked_ratio = 0.75;  ///< agreeing features, relative to those of the last key frame
  int max_interval_frames = 30;
  int looks_kept = 3;  ///< key frames of one place whose points stay in the map; the oldest goes

  template <class Archive>
  void visit(Archive& a) {
    a("max_translation_ratio", max_translation_ratio, {.min = 0.001, .max = 10});
    a("max_rotation_deg", max_rotation_deg, {.min = 0.1, .max = 180});
    a("min_tracked_ratio", min_tracked_ratio, {.min = 0, .max = 1});
    a("max_interval_frames", max_interval_frames, {.min = 1, .max = 100000});
    a("looks_kept", looks_kept, {.min = 1, .max = 10000});
  }
};

/// What is done beside the frame path, on a second core. YAML: slam.background
struct BackgroundOptions {
  bool threads = true;            ///< false: done at once, with the same results at the same frames
  int adjustment_lag_frames = 2;  ///< after a key frame, until its adjustment enters
  int map_lag_frames = 12;        ///< after a key frame, until what was recognised in it enters
  int astray_lag_frames = 6;      ///< the same after track was lost, until a stored place is recognised

  template <class Archive>
  void visit(Archive& a) {
    a("threads", threads);
    a("adjustment_lag_frames", adjustment_lag_frames, {.min = 1, .max = 1000});
    a("map_lag_frames", map_lag_frames, {.min = 1, .max = 1000});
    a("astray_lag_frames", astray_lag_frames, {.min = 1, .max = 1000});
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
  AdjustmentOptions adjustment;
  FlogOptions mapping;
  DenseMapOptions dense_map;
  LoopOptions loop;
  MapMatchOptions map_match;
  BackgroundOptions background;

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
    a("adjustment", adjustment);
    a("mapping", mapping);
    a("dense_map", dense_map);
    a("loop", loop);
    a("map_match", map_match);
    a("background", background);
  }
};

/// Names of the presets, in the order in which help shows them.
std::vector<std::string> preset_names();

/// @param name "paper" (the faithful method) or "default" (the best this project has)
/// @throws InputError naming the presets
SlamOptions preset(const std::string& name);

}  // namespace groundloop::slam
