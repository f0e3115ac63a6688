#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/metrics/truth/loop_truth.h"
#include "bench/report/footprint.h"
#include "bench/report/run_folder.h"
#include "slam/pipeline/pipeline.h"

namespace groundloop::bench {

/// What the bench adds to a frame's result in frames.csv; NaN where it was not measured.
struct FrameNotes {
  double render_ms;
  double disparity_error_px;
  double track_error_px;
  double position_error_m;
  double memory_mb;    ///< resident after this frame
  std::string faults;  ///< kinds active since the frame before, as "drop+blur"; empty when all was well
  double exposure_s = std::numeric_limits<double>::quiet_NaN();  ///< of a raw head's left camera
  double gain_db = std::numeric_limits<double>::quiet_NaN();
};

// Writers of the run folder's files (README.md lists them). bench/report/run_folder.h reads them. All numbers
// are written so that they read back exactly. All throw InputError when a file cannot be written.

void write_run_json(const std::string& file, const RunHeader& header);
void write_metrics_json(const std::string& file, const Metrics& metrics);
void write_frames_csv(const std::string& file, const std::vector<slam::FrameResult>& frames,
                      const std::vector<FrameNotes>& notes);
void write_key_frames_csv(const std::string& file, const std::vector<slam::KeyFrameRecord>& key_frames);
/// Links in the order in which they entered, beside the truth; NaN where there is none.
void write_links_csv(const std::string& file, const std::vector<JudgedLink>& links);
void write_cloud_ply(const std::string& file, const std::vector<slam::CloudPoint>& cloud);
/// {"T_world_map": [16 numbers, row by row]}
void write_alignment_json(const std::string& file, const slam::Pose& T_world_map);
/// [{"name": ..., "polygon": [[x, y], ...]}, ...] in the world frame
void write_outline_json(const std::string& file, const std::vector<Footprint>& outline);
/// Height layers: FOLDER/map.bt (OctoMap) and FOLDER/layer_0.pgm + .yaml upwards.
void write_map3d(const std::string& folder, const std::vector<slam::OccupancyMap>& layers,
                 const std::vector<double>& layer_heights_m);

}  // namespace groundloop::bench
