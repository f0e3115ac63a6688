#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "slam/types/config.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

enum class TrajectoryFormat {
  kTum,    ///< seconds x y z qx qy qz qw, separated by blanks
  kKitti,  ///< the 12 numbers of a 3x4 matrix, row by row, separated by blanks; no stamps
  kEuroc   ///< nanoseconds, x, y, z, qw, qx, qy, qz and any further columns, separated by commas
};

/// What the times of a file may do.
enum class StampOrder {
  kRising,  ///< a time that goes back is an error
  kAny      ///< poses are put in order of time
};

struct TrajectoryFile {
  std::string file;
  TrajectoryFormat format = TrajectoryFormat::kTum;
  slam::Trajectory poses;  ///< stamps never decrease; KITTI poses are stamped 0 s, 1 s, 2 s, ...

  bool has_stamps() const { return format != TrajectoryFormat::kKitti; }
};

/// Reads a trajectory. Empty lines and lines that start with # are skipped; quaternions are normalised;
/// KITTI matrices are kept as they are in the file, as other tools do.
/// @throws InputError naming file, line, value and what was wanted (the first 20 such problems): a wrong
/// number of
///   columns, not a finite number, a quaternion or matrix that is not a rotation, stamps that go back, no
///   pose.
TrajectoryFile read_trajectory(const std::string& file, TrajectoryFormat format);

/// The same, with the format told from the columns of the first pose.
TrajectoryFile read_trajectory(const std::string& file, StampOrder order = StampOrder::kRising);

/// Writes TUM (stamps to the nanosecond, other numbers with 12 decimals) or KITTI.
/// @throws InputError when the file cannot be written
void write_tum(const std::string& file, const slam::Trajectory& poses);
void write_kitti(const std::string& file, const slam::Trajectory& poses);

/// Text of one TUM line, without its end.
std::string tum_line(const slam::StampedPose& pose);

}  // namespace groundloop::bench

namespace groundloop {
template <>
struct EnumNames<bench::TrajectoryFormat> {
  static constexpr std::array<std::pair<bench::TrajectoryFormat, const char*>, 3> names = {
      {{bench::TrajectoryFormat::kTum, "tum"},
       {bench::TrajectoryFormat::kKitti, "kitti"},
       {bench::TrajectoryFormat::kEuroc, "euroc"}}};
};
}  // namespace groundloop
