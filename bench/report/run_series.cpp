#include "bench/report/run_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/metrics/association.h"
#include "bench/report/plan_drawing.h"

namespace groundloop::bench {
namespace {

slam::Trajectory moved(const slam::Pose& T_frame_from, const slam::Trajectory& trajectory) {
  slam::Trajectory result = trajectory;
  for (auto& pose : result) pose.T = T_frame_from * pose.T;
  return result;
}

/// Links between the positions of their frames on the final trajectory; frame k is its k-th pose.
std::vector<DrawnLink> links_of(const RunFolder& run, const slam::Trajectory& estimate) {
  const auto frames = static_cast<int64_t>(estimate.size());
  std::vector<DrawnLink> links;
  for (const LinkRow& row : run.links) {
    if (row.from_index < 0 || row.to_index < 0 || row.from_index >= frames || row.to_index >= frames)
      continue;
    const auto position = [&](int64_t i) { return estimate[static_cast<size_t>(i)].T.translation(); };
    links.push_back({position(row.from_index), position(row.to_index), row.wrong});
  }
  return links;
}

}  // namespace

PlacedRun placed(const RunFolder& run) {
  PlacedRun result;
  const bool in_world = run.header.kind == "run" && run.T_world_map.has_value();
  if (in_world) {
    result.T_frame_map = *run.T_world_map;
    result.view.truth = run.truth;
    result.view.outline = run.outline;
  } else if (run.T_world_map) {
    result.view.truth = moved(run.T_world_map->inverse(), run.truth);
  }
  result.view.estimate = moved(result.T_frame_map, run.estimate);
  result.view.without_links = moved(result.T_frame_map, run.without_links);
  result.view.links = links_of(run, result.view.estimate);
  for (const KeyFrameRow& row : run.key_frames) {
    result.view.key_frames.push_back(result.T_frame_map * row.T_map_left);
  }
  const Eigen::Isometry3f T_frame_map = result.T_frame_map.cast<float>();
  for (const slam::PlyPoint& point : run.cloud) {
    result.view.cloud.push_back({T_frame_map * point.p_map, point.sigma_m});
  }
  return result;
}

ErrorSeries error_series(const TopView& view, int64_t first_stamp_ns) {
  ErrorSeries series;
  if (view.truth.empty() || view.estimate.empty()) return series;
  const PosePairs pairs = associate_by_time(view.truth, view.estimate);
  for (size_t i = 0; i < pairs.size(); ++i) {
    const slam::Pose& T_frame_true = pairs.truth[i].T;
    const slam::Pose& T_frame_left = pairs.estimate[i].T;
    series.t_s.push_back(static_cast<double>(pairs.estimate[i].stamp_ns - first_stamp_ns) * 1e-9);
    series.position_m.push_back((T_frame_left.translation() - T_frame_true.translation()).norm());
    const double difference_rad =
        heading_of_camera(T_frame_left).yaw_rad - heading_of_camera(T_frame_true).yaw_rad;
    series.yaw_deg.push_back(std::remainder(difference_rad, 2 * M_PI) * 180 / M_PI);
  }
  return series;
}

int64_t first_stamp_ns(const RunFolder& run) {
  const auto& stamps = run.frames.column("stamp_ns");
  if (!stamps.empty()) return static_cast<int64_t>(stamps.front());
  return run.estimate.empty() ? 0 : run.estimate.front().stamp_ns;
}

std::vector<double> frame_times_s(const FrameTable& frames) {
  std::vector<double> times = frames.column("stamp_ns");
  if (times.empty()) return times;
  const double first_ns = times.front();
  for (double& t : times) t = (t - first_ns) * 1e-9;
  return times;
}

std::vector<std::pair<double, double>> lost_spans_s(const FrameTable& frames) {
  const std::vector<double> times = frame_times_s(frames);
  std::vector<std::pair<double, double>> spans;
  bool was_lost = false;
  for (size_t i = 0; i < std::min(times.size(), frames.status.size()); ++i) {
    const bool lost = frames.status[i] == "lost";
    const double end_s = times[std::min(i + 1, times.size() - 1)];
    if (lost && was_lost) spans.back().second = end_s;
    if (lost && !was_lost) spans.emplace_back(times[i], end_s);
    was_lost = lost;
  }
  return spans;
}

double percentile(const std::vector<double>& values, double fraction) {
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double v) { return std::isfinite(v); });
  if (known.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(known.begin(), known.end());
  const double rank = fraction * static_cast<double>(known.size() - 1);
  const auto below = static_cast<size_t>(rank);
  const size_t above = std::min(below + 1, known.size() - 1);
  return known[below] + (rank - static_cast<double>(below)) * (known[above] - known[below]);
}

}  // namespace groundloop::bench
