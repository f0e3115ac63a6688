#include "bench/metrics/correction.h"

#include <algorithm>

#include "bench/metrics/alignment.h"
#include "bench/metrics/pose_error.h"
#include "bench/metrics/statistics.h"

namespace groundloop::bench {
namespace {

double ate_rmse_m(const slam::Trajectory& truth, const slam::Trajectory& estimate) {
  PosePairs pairs{truth, estimate};
  align(pairs, AlignMode::kSe3);
  return statistics(absolute_errors(pairs, PoseRelation::kTranslationPart)).rmse;
}

}  // namespace

slam::Trajectory without_links(const std::vector<slam::FrameResult>& frames,
                               const slam::Trajectory& final_T_map_left) {
  slam::Trajectory chained;
  const bool any =
      std::any_of(frames.begin(), frames.end(), [](const slam::FrameResult& f) { return !f.links.empty(); });
  if (!any) return chained;
  chained.reserve(frames.size());
  chained.push_back({frames[0].stamp_ns, frames[0].T_map_left});
  for (size_t i = 1; i < frames.size(); ++i) {
    const slam::Pose T_step = frames[i].links.empty()
                                  ? frames[i - 1].T_map_left.inverse() * frames[i].T_map_left
                                  : final_T_map_left[i - 1].T.inverse() * final_T_map_left[i].T;
    chained.push_back({frames[i].stamp_ns, chained.back().T * T_step});
  }
  return chained;
}

Metrics correction_metrics(const slam::Trajectory& T_world_left, const slam::Trajectory& without_links,
                           const slam::Trajectory& final_T_map_left) {
  if (without_links.empty()) return {};
  return {{"loop.ate_before_m", ate_rmse_m(T_world_left, without_links)},
          {"loop.ate_after_m", ate_rmse_m(T_world_left, final_T_map_left)}};
}

}  // namespace groundloop::bench
