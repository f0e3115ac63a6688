#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/report/figures.h"
#include "bench/report/run_folder.h"

namespace groundloop::bench {

/// A run's geometry in one frame with z up: the world of a simulated run; the map of a replay, whose recorded
/// truth may have any axes. A truth that no alignment relates to the map is left out.
struct PlacedRun {
  TopView view;
  slam::Pose T_frame_map = slam::Pose::Identity();
};
PlacedRun placed(const RunFolder& run);

/// How far the estimate is from the truth at each time both know; seconds since the first pair.
struct ErrorSeries {
  std::vector<double> t_s;
  std::vector<double> position_m;
  std::vector<double>
      yaw_deg;  ///< estimated minus true heading of the optical axis on the floor, in (-180, 180]
};
ErrorSeries error_series(const TopView& view, int64_t first_stamp_ns);

/// Time of each row of frames.csv in seconds since the first.
std::vector<double> frame_times_s(const FrameTable& frames);

/// Spans of time in which the status was "lost".
std::vector<std::pair<double, double>> lost_spans_s(const FrameTable& frames);

/// Stamp of the first frame, pose or 0.
int64_t first_stamp_ns(const RunFolder& run);

/// Value below which a fraction of the values lies (linear between neighbours), NaN left out; NaN when there
/// is none.
double percentile(const std::vector<double>& values, double fraction);

}  // namespace groundloop::bench
