#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"

namespace groundloop::bench {

/// `groundloop frame`: makes one pair of a scenario again, alone, and writes it beside its exact truth.
/// Physics runs up to the pair; only this pair is rendered. Its images are those of the run, byte for byte.
///
///   left.png, right.png      what the core gets (of a raw head: rectified)
///   depth.pfm                z [m] of the left image, infinite where nothing is (PFM: rows bottom-up)
///   disparity.png            KITTI's 16 bits: 256 times the disparity [px], 0 where nothing is
///   flow.flo                 Middlebury: motion of every left pixel to the next pair; 1e10 where unknown
///   geoms.png, instances.png 16 bits: geom id + 1, body id + 1; 0 where nothing is. Names in labels.csv
///   visible_right.png        255 where the right camera sees the left image's surface
///   visible_next.png         255 where the left camera of the next pair does
///   moving.png               255 where the surface moves in the world until the next pair
/// Files that speak of the next pair are not written for the last one.
///
/// @param frame   index of the pair, as in frames.csv
/// @param folder  made when there is none; files in it are replaced
/// @return the files written
/// @throws InputError when the scenario cannot be run, has no such pair, or steers by the SLAM (whose poses
/// are not known here)
std::vector<std::string> export_frame(const sim::Scenario& scenario, int64_t frame,
                                      const std::string& folder);

}  // namespace groundloop::bench
