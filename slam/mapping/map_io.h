#pragma once

#include <string>
#include <vector>

#include "slam/types/occupancy_map.h"

namespace groundloop::slam {

/// Writes a map as ROS map_server reads it: an 8-bit PGM (P5), its first row the map's highest y, beside a
/// YAML with the same stem (image, mode trinary, resolution, origin, negate 0, occupied_thresh 0.65,
/// free_thresh 0.35). A cell's grey is 254 (1 - value) rounded: map_server's p = (255 - grey) / 255 then
/// falls on the same side of the thresholds as the value does. Unknown cells are therefore 127. The 205 of
/// map_saver would be wrong here: it means unknown only beside free_thresh 0.196, and would make unknown
/// cells free beside 0.35. A map without cells is written as one unknown cell, for a PGM cannot be empty.
/// @param stem  path without ending: stem.pgm and stem.yaml are written
/// @throws InputError naming the file that cannot be written
void write_map(const std::string& stem, const OccupancyMap& map);

/// Reads what write_map wrote, to half a grey level. Maps of other makers, that is with other thresholds, are
/// read as map_server's trinary mode does: 0 free, 1/2 unknown, 1 occupied.
/// @param yaml_file  path of the YAML; the image is taken relative to it
/// @throws InputError naming file, key and value
OccupancyMap read_map(const std::string& yaml_file);

/// Writes height layers as an OctoMap binary tree (.bt): a voxel is occupied or free where its layer is.
/// @param layers           maps on one geometry, lowest first
/// @param layer_heights_m  layers.size() + 1 rising heights: layer i lies between [i] and [i+1]
/// @throws InputError naming the file that cannot be written
void write_octomap(const std::string& file, const std::vector<OccupancyMap>& layers,
                   const std::vector<double>& layer_heights_m);

}  // namespace groundloop::slam
