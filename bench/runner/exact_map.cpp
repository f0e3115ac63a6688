#include "bench/runner/exact_map.h"

#include <algorithm>

namespace groundloop::bench {
namespace {

constexpr double kSight_m = 8.0;    // how far a cell may be to count as seen
constexpr int64_t kSightEvery = 5;  // frames between the poses whose sight is cast

}  // namespace

ExactMapper::ExactMapper(const SceneInTime& scene, const slam::StereoRig& rig, double cell_m)
    : scene_(scene), rig_(rig) {
  exact_.map = scene.standing().occupancy(scene.standing().bounds(cell_m), kBandMin_m, kBandMax_m);
  exact_.sight.assign(exact_.map.geometry.cells(), 0);
}

void ExactMapper::look_again() {
  const slam::OccupancyMap before = exact_.map;
  exact_.map = scene_.standing().occupancy(before.geometry, kBandMin_m, kBandMax_m);
  for (size_t i = 0; i < exact_.sight.size(); ++i) {
    if (exact_.map.value[i] != before.value[i]) exact_.sight[i] = 0;
  }
}

void ExactMapper::look(int64_t frame, const slam::Pose& T_world_left) {
  if (frame % kSightEvery != 0) return;
  const std::vector<uint8_t> seen = scene_.seen().visible_cells(exact_.map.geometry, rig_, {T_world_left},
                                                                kBandMin_m, kBandMax_m, kSight_m);
  for (size_t i = 0; i < seen.size(); ++i) exact_.sight[i] = std::max(exact_.sight[i], seen[i]);
}

}  // namespace groundloop::bench
