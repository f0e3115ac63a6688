#pragma once

#include <future>

#include "bench/runner/output_folder.h"
#include "slam/pipeline/pipeline.h"

namespace groundloop::bench {

/// What the core itself made: estimate.tum, keyframes.csv, cloud.ply, map.pgm + .yaml.
void write_core_files(const OutputFolder& out, const slam::Pipeline& core);

/// And map3d/, in a thread of its own: the octree takes half a second, and no other file needs it. Its error,
/// an InputError when a file cannot be written, comes with the future; the folder must not be published
/// before.
std::future<void> map3d_beside(const OutputFolder& out, const slam::Pipeline& core);

}  // namespace groundloop::bench
