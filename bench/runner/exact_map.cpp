#include "bench/runner/exact_map.h"

#include <algorithm>

namespace groundloop::bench {
namespace {

constexpr int64_t kSightEvery = 5;  // frames between the poses whose sight is cast

}  // namespace

ExactMapper::ExactMapper(const SceneInTime& scene, const slam::StereoRig& rig, double cell_m)
    : scene_(scene), rig_(rig) {
  const MapBand& band = scene.band();
  exact_.map = scene.standing().occupancy(scene.standing().bounds(cell_m), band.min_m, band.max_m);
  exact_.sight.assign(exact_.map.geometry.cells(), 0);
}

void ExactMapper::look_again() {
  const slam::OccupancyMap before = exact_.map;
  exact_.map = scene_.standing().occupancy(before.geometry, scene_.band().min_m, scene_.band().max_m);
  for (size_t i = 0; i < exact_.sight.size(); ++i) {
    if (exact_.map.value[i] != before.value[i]) exact_.sight[i] = 0;
  }
}

void ExactMapper::look(int64_t frame, const slam::Pose& T_world_left) {
  if (frame % kSightEvery != 0) return;
  const MapBand& band = scene_.band();
  const std::vector<uint8_t> seen = scene_.seen().visible_cells(exact_.map.geometry, rig_, {T_world_left},
                                                                band.min_m, band.max_m, band.sight_m);
  for (size_t i = 0; i < seen.size(); ++i) exact_.sight[i] = std::max(exact_.sight[i], seen[i]);
}

}  // namespace groundloop::bench
