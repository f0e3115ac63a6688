#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace groundloop::slam {

/// One point of a cloud file.
struct PlyPoint {
  Eigen::Vector3f p_map = Eigen::Vector3f::Zero();  ///< [m]
  uint8_t grey = 0;
  float sigma_m = 0;  ///< standard deviation along its ray
};

/// Writes a PLY, binary little endian: x y z (float), red green blue (uchar, all the grey), sigma (float).
/// @throws InputError naming the file that cannot be written
void write_ply(const std::string& file, const std::vector<PlyPoint>& points);

/// Reads what write_ply wrote.
/// @throws InputError naming file and line of the header, or the missing data
std::vector<PlyPoint> read_ply(const std::string& file);

}  // namespace groundloop::slam
