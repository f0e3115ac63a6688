#include "bench/runner/core_files.h"

#include "bench/metrics/trajectory_file.h"
#include "bench/runner/run_files.h"
#include "slam/mapping/map_io.h"

namespace groundloop::bench {

void write_core_files(const OutputFolder& out, const slam::Pipeline& core) {
  write_tum(out.file("estimate.tum"), core.trajectory());
  write_key_frames_csv(out.file("keyframes.csv"), core.key_frames());
  write_cloud_ply(out.file("cloud.ply"), core.cloud());
  slam::write_map(out.file("map"), core.map());
}

std::future<void> map3d_beside(const OutputFolder& out, const slam::Pipeline& core) {
  return std::async(std::launch::async, [folder = out.file("map3d"), layers = core.layers(),
                                         heights_m = core.options().mapping.layer_heights_m] {
    write_map3d(folder, layers, heights_m);
  });
}

}  // namespace groundloop::bench
