#include "bench/runner/timing_metrics.h"

#include <algorithm>

#include "bench/runner/provenance.h"

namespace groundloop::bench {
namespace {

/// The value below which the given part of the values lies (nearest rank).
double quantile(std::vector<double> values, double part) {
  const auto rank = static_cast<size_t>(part * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

}  // namespace

Metrics timing_metrics(const std::vector<slam::FrameResult>& frames, const std::vector<double>& render_ms,
                       double wall_s) {
  Metrics metrics;
  std::vector<double> all_ms, key_ms;
  for (const slam::FrameResult& frame : frames) {
    all_ms.push_back(frame.total_ms);
    if (frame.is_key_frame) key_ms.push_back(frame.total_ms);
  }
  if (!all_ms.empty()) {
    metrics["timing.slam_ms_median"] = quantile(all_ms, 0.5);
    metrics["timing.slam_ms_p99"] = quantile(all_ms, 0.99);
    const double sequence_s = 1e-9 * static_cast<double>(frames.back().stamp_ns - frames.front().stamp_ns);
    metrics["timing.realtime_factor"] = sequence_s / wall_s;
  }
  if (!key_ms.empty()) metrics["timing.keyframe_ms_median"] = quantile(key_ms, 0.5);
  if (!render_ms.empty()) metrics["timing.render_ms"] = quantile(render_ms, 0.5);
  metrics["timing.wall_s"] = wall_s;
  metrics["peak_memory_mb"] = peak_memory_mb();
  return metrics;
}

}  // namespace groundloop::bench
