#include "slam/mapping/mapper.h"

namespace groundloop::slam {

Mapper::Mapper(const StereoRig& rig, const FlogOptions& options)
    : rig_(rig), options_(options), local_(options, rig), grid_(options) {}

void Mapper::add(const Pose& T_map_left, std::span<const MapObservation> observations) {
  points_.clear();
  for (const MapObservation& observation : observations) {
    const auto point = map_point(rig_, T_map_left, observation.uvu_px.cast<double>(),
                                 options_.sigma_disparity_px, observation.weight);
    if (point) points_.push_back(*point);
  }
  local_.add_key_frame(T_map_left.translation(), points_);
  local_.add_to(grid_);
}

}  // namespace groundloop::slam
