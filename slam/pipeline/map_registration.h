#pragma once

#include <deque>
#include <optional>

#include "slam/loop/place_map.h"
#include "slam/mapping/grid_matcher.h"
#include "slam/mapping/map_builder.h"
#include "slam/mapping/map_match_options.h"

namespace groundloop::slam {

/// Where the local map says that the newest key frame stands, seen from an earlier one.
struct MapSight {
  int from_key_frame = 0;
  Pose T_from_to = Pose::Identity();       ///< newest left camera in the earlier one
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_from_to, right perturbation
  int cells = 0;                           ///< of the local map that agree with the global one
};

/// Corrects the estimated motion by registering the local map, of the newest looks, to the global one, of the
/// looks that are old enough not to share the local one's errors. Section 3.2 of the paper, as an outlook: a
/// narrow view may not have enough structure, a head that looks around gives it.
class MapRegistration {
 public:
  MapRegistration(const StereoRig& rig, const FlogOptions& mapping, const MapMatchOptions& options,
                  int looks_kept);

  /// Takes in a look. Looks before it enter the global map when they are old enough.
  /// @param frame           of the look
  /// @param starts_segment  whether track was lost before: the local map begins anew
  void add(Look look, int64_t frame, bool starts_segment);

  /// Registers the maps when it is due and when the newest look's pose is known too little; none otherwise,
  /// or when the maps have not enough structure. The global map is drawn once poses begin to be uncertain, a
  /// few looks a call.
  std::optional<MapSight> match(PlaceMap& places);

 private:
  struct Held {
    Look look;
    int64_t frame;
  };
  double planar_sigma_m(const RelativeMotion& known) const;
  const Look* nearest_old_look(const Pose& T_map_left, const std::vector<Pose>& T_map_place) const;
  bool on_one_floor(const Pose& T_body_matched, const Matrix6d& known_body) const;
  Eigen::Vector3d upright_variance() const;  ///< of z, roll, pitch
  Matrix6d covariance_of(const MapMatch& match) const;
  OccupancyMap local_map(const Pose& T_map_local, const std::vector<Pose>& T_map_place) const;

  StereoRig rig_;
  FlogOptions mapping_;
  MapMatchOptions options_;
  MapBuilder global_;
  std::deque<Held> held_;  ///< looks too young for the global map
  int in_segment_ = 0;     ///< looks since track was lost
  int until_next_;         ///< looks until the maps are compared again
};

}  // namespace groundloop::slam
