#include "bench/metrics/association.h"

#include <algorithm>
#include <cmath>

namespace groundloop::bench {
namespace {

std::vector<double> seconds_of(const slam::Trajectory& poses, double offset_s) {
  std::vector<double> seconds;
  seconds.reserve(poses.size());
  for (const slam::StampedPose& pose : poses) {
    seconds.push_back(static_cast<double>(static_cast<long double>(pose.stamp_ns) / 1e9L) + offset_s);
  }
  return seconds;
}

/// Index of the first of the stamps nearest to t.
size_t nearest(const std::vector<double>& stamps_s, double t_s) {
  const auto after = std::lower_bound(stamps_s.begin(), stamps_s.end(), t_s);
  if (after == stamps_s.begin()) return 0;
  const double before_s = *(after - 1);
  const bool before_is_nearer = after == stamps_s.end() || t_s - before_s <= *after - t_s;
  const auto found = before_is_nearer ? std::lower_bound(stamps_s.begin(), after, before_s) : after;
  return static_cast<size_t>(found - stamps_s.begin());
}

}  // namespace

PosePairs associate_by_time(const slam::Trajectory& truth, const slam::Trajectory& estimate,
                            const AssociationOptions& options) {
  PosePairs pairs;
  if (truth.empty() || estimate.empty()) return pairs;
  // The offset is given to the longer one's stamps, so that rounding falls as it does in evo.
  const bool estimate_is_longer = estimate.size() > truth.size();
  const slam::Trajectory& shorter = estimate_is_longer ? truth : estimate;
  const slam::Trajectory& longer = estimate_is_longer ? estimate : truth;
  const auto short_s = seconds_of(shorter, 0);
  const auto long_s = seconds_of(longer, estimate_is_longer ? options.offset_s : -options.offset_s);
  for (size_t i = 0; i < short_s.size(); ++i) {
    const size_t j = nearest(long_s, short_s[i]);
    if (std::abs(long_s[j] - short_s[i]) > options.max_difference_s) continue;
    pairs.truth.push_back(estimate_is_longer ? shorter[i] : longer[j]);
    pairs.estimate.push_back(estimate_is_longer ? longer[j] : shorter[i]);
  }
  return pairs;
}

}  // namespace groundloop::bench
