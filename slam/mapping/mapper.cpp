#include "slam/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace groundloop::slam {
namespace {

template <class Unit>
Unit nearest(double value) {
  using Limits = std::numeric_limits<Unit>;
  return static_cast<Unit>(std::clamp<double>(std::round(value), Limits::min(), Limits::max()));
}

}  // namespace

MapObservation::MapObservation(const Eigen::Vector3f& uvu_px, float weight, float sigma_px)
    : u_left_(nearest<uint16_t>(uvu_px.x() * kPositionUnits)),
      v_(nearest<uint16_t>(uvu_px.y() * kPositionUnits)),
      disparity_(nearest<int16_t>((uvu_px.x() - uvu_px.z()) * kDisparityUnits)),
      weight_(nearest<uint8_t>(weight * kWeightUnits)),
      sigma_(nearest<uint8_t>(sigma_px * kSigmaUnits)) {}

Mapper::Mapper(const StereoRig& rig, const FlogOptions& options)
    : rig_(rig), options_(options), local_(options, rig), grid_(options) {}

void Mapper::add(const Pose& T_map_left, std::span<const MapObservation> observations) {
  points_.clear();
  for (const MapObservation& observation : observations) {
    const double sigma_px = observation.sigma_px() > 0 ? observation.sigma_px() : options_.sigma_disparity_px;
    const auto point = map_point(rig_, T_map_left, observation.uvu_px(), sigma_px, observation.weight());
    if (point) points_.push_back(*point);
  }
  local_.add_key_frame(T_map_left.translation(), points_);
  local_.add_to(grid_);
}

}  // namespace groundloop::slam
