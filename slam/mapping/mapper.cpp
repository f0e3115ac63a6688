#include "slam/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <future>
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
    : rig_(rig), options_(options), sheet_{LocalMap(options, rig), {}}, grid_(options) {}

void Mapper::add(const Pose& T_map_left, std::span<const MapObservation> observations) {
  draw(T_map_left, observations, sheet_);
  sheet_.local.add_to(grid_);
}

void Mapper::add_by_two(std::span<const PosedObservations> key_frames) {
  Sheet second{LocalMap(options_, rig_), {}};
  const auto draw_on = [&](const PosedObservations& seen, Sheet& sheet) {
    draw(seen.T_map_left, *seen.observations, sheet);
  };
  for (; key_frames.size() > 1; key_frames = key_frames.subspan(2)) {
    std::future<void> beside =
        std::async(std::launch::async, [&, next = &key_frames[1]] { draw_on(*next, second); });
    draw_on(key_frames[0], sheet_);
    sheet_.local.add_to(grid_);
    beside.get();
    second.local.add_to(grid_);
  }
  if (!key_frames.empty()) add(key_frames[0].T_map_left, *key_frames[0].observations);
}

void Mapper::draw(const Pose& T_map_left, std::span<const MapObservation> observations, Sheet& sheet) const {
  sheet.points.clear();
  for (const MapObservation& observation : observations) {
    const double sigma_px = observation.sigma_px() > 0 ? observation.sigma_px() : options_.sigma_disparity_px;
    const auto point = map_point(rig_, T_map_left, observation.uvu_px(), sigma_px, observation.weight());
    if (point) sheet.points.push_back(*point);
  }
  sheet.local.add_key_frame(T_map_left.translation(), sheet.points);
}

}  // namespace groundloop::slam
