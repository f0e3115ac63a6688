#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/loop/loop_detector.h"
#include "slam/loop/place_map.h"
#include "slam/mapping/map_builder.h"
#include "slam/pipeline/map_registration.h"
#include "slam/pipeline/options.h"
#include "slam/stereo/dense_points.h"
#include "slam/types/oracle.h"

namespace groundloop::slam {

/// What the frame path hands over of a key frame.
struct HandedOver {
  OdometryPose pose;
  std::vector<OdometryPose> known_better;  ///< earlier key frames that were refined meanwhile
  bool starts_segment = false;
  Pose T_map_left = Pose::Identity();        ///< where it is believed to be, when it starts a segment
  LoopKeyFrame sight;                        ///< images only when somebody looks at them
  Look look;                                 ///< without observations and place
  std::vector<MapObservation> observations;  ///< its features; the back end adds dense points
};

/// What the back end knows after a key frame.
struct BackEndAnswer {
  int key_frame = 0;
  int tie = 0;                   ///< that this key frame, and those that follow, hang on
  std::vector<Pose> T_map_odom;  ///< by tie: T_map_left = T_map_odom[tie] T_odom_left
  std::optional<LoopLink> link;
  double loop_ms = 0, mapping_ms = 0;
};

/// What is done with key frames beside the frame path: recognising places, correcting the map, drawing it.
/// One thread uses it.
class BackEnd {
 public:
  /// @param oracle  answers in the place of recognition, in experiments; may be null, must outlive this
  BackEnd(const StereoRig& rig, const SlamOptions& options, const Oracle* oracle);

  BackEndAnswer process(HandedOver handed_over);
  /// Takes over the last refined poses and draws the whole map anew where it all is now.
  BackEndAnswer finish(const std::vector<OdometryPose>& known_better);

  const MapBuilder& map() const { return map_; }
  const PlaceMap& places() const { return places_; }

 private:
  /// Finds out where the key frame is, and makes it a place when it is a new one.
  void recognise(const HandedOver& handed_over, std::optional<LoopLink>& link);
  void tie(Look& look) const;
  void look_densely(const LoopKeyFrame& sight, std::vector<MapObservation>& observations);
  void register_map(std::optional<LoopLink>& link);
  std::optional<LoopLink> ask_oracle(int64_t frame) const;
  int key_frame_of(int64_t frame) const;
  BackEndAnswer answer() const;

  SlamOptions options_;
  const Oracle* exact_loops_;   ///< null unless it replaces recognition
  const Oracle* exact_stereo_;  ///< null unless it replaces stereo
  LoopDetector detector_;
  PlaceMap places_;
  DensePoints dense_points_;
  MapBuilder map_;
  std::optional<MapRegistration> map_registration_;  ///< none when it is not wanted
  std::vector<int64_t> frames_;                      ///< by key frame
  std::vector<int> stored_places_;                   ///< key frames that exact_loops_ may recognise
};

}  // namespace groundloop::slam
