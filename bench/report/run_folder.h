#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/report/footprint.h"
#include "slam/mapping/cloud_io.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

// The run folder as a reader sees it. Only run.json must exist; whatever else is missing stays empty.

/// One expectation of the scenario and how it came out. JSON: {metric, value, min, max, ok}; bounds may be
/// null.
struct JudgedMetric {
  std::string metric;
  std::optional<double> value;  ///< none: the run did not produce the metric
  std::optional<double> min;
  std::optional<double> max;
  bool ok = false;
};

/// run.json
struct RunHeader {
  std::string version;  ///< of groundloop
  std::string name;
  std::string summary;
  uint64_t seed = 0;
  std::string kind = "run";  ///< "run": simulated, judged in the world frame; "replay": recorded images
  std::string preset;
  std::string oracles;  ///< stages replaced by exact answers ("tracking+stereo"); empty in every ordinary run
  int64_t frames = 0;
  std::map<std::string, std::string> renderer;  ///< backend, renderer, version, samples
  std::string isa;
  std::map<std::string, std::string> hashes;  ///< input -> hash
  std::string result;                         ///< verdict.result: "pass", "fell short" or "error"
  std::vector<JudgedMetric> judged;           ///< verdict.lines
  std::vector<std::string> argv;              ///< command that made the run; may be empty
};

/// keyframes.csv: index,stamp_ns,segment,x,y,z,qx,qy,qz,qw (left camera in map), then the upper triangle of
/// the covariance of the motion from the key frame before (c00, c01 .. c55), which the report does not need
struct KeyFrameRow {
  int64_t index = 0;
  int64_t stamp_ns = 0;
  int segment = 0;
  slam::Pose T_map_left = slam::Pose::Identity();
};

/// links.csv: kind,from_index,to_index,x,y,z,qx,qy,qz,qw,inliers,residual_px,overlap,error_m,error_deg,right
/// (the last four are empty without a truth). What the report needs of it:
struct LinkRow {
  int64_t from_index = 0;
  int64_t to_index = 0;
  bool wrong = false;  ///< by the truth
};

/// One run of oracles.json: [{"exact", "outcome", "metrics": {name: number}}]
struct OracleRow {
  std::string exact;  ///< stages with exact answers; empty: the run as it is
  std::string outcome;
  std::map<std::string, double> metrics;
};

/// frames.csv: a header row, then one row a frame. Columns are found by name and may be missing; cells may be
/// empty.
struct FrameTable {
  size_t rows = 0;
  std::vector<std::string> status;                     ///< column "status"
  std::map<std::string, std::vector<double>> columns;  ///< numeric columns; NaN where a cell is empty
  /// Values of a column, empty when the file has none of that name.
  const std::vector<double>& column(const std::string& name) const;
};

struct RunFolder {
  std::string dir;
  RunHeader header;
  slam::Trajectory truth;          ///< truth.tum: left camera in world; seconds x y z qx qy qz qw
  slam::Trajectory estimate;       ///< estimate.tum: left camera in map
  slam::Trajectory without_links;  ///< without_links.tum: the estimate had no place been recognised
  std::vector<LinkRow> links;
  std::vector<OracleRow> oracles;
  std::vector<KeyFrameRow> key_frames;
  FrameTable frames;
  std::map<std::string, double> metrics;        ///< metrics.json; a null is left out
  std::optional<slam::Pose> T_world_map;        ///< alignment.json {"T_world_map": [16 numbers, row-major]}
  std::vector<slam::PlyPoint> cloud;            ///< cloud.ply (slam::write_ply), map frame
  std::optional<slam::OccupancyMap> map;        ///< map.yaml + map.pgm (slam::write_map), map frame
  std::optional<slam::OccupancyMap> truth_map;  ///< truth_map.yaml + .pgm, world frame
  std::optional<slam::OccupancyMap>
      visible;                     ///< visible.yaml + .pgm on truth_map's grid: 1 what the true path saw
  std::vector<Footprint> outline;  ///< outline.json [{"name", "polygon": [[x, y], ...]}], world frame
};

/// @throws InputError naming file, line where there is one, key, value and what was wanted
RunFolder load_run_folder(const std::string& dir);

}  // namespace groundloop::bench
