#pragma once

#include "bench/runner/output_folder.h"
#include "slam/pipeline/pipeline.h"

namespace groundloop::bench {

/// Everything the core itself made: estimate.tum, keyframes.csv, cloud.ply, map.pgm + .yaml, map3d/.
void write_core_files(const OutputFolder& out, const slam::Pipeline& core);

}  // namespace groundloop::bench
