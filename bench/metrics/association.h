#pragma once

#include <utility>
#include <vector>

#include "slam/types/pose.h"

namespace groundloop::bench {

/// Poses of two trajectories that belong together: first[i] and second[i] are of the same time.
struct PosePairs {
  slam::Trajectory truth;
  slam::Trajectory estimate;

  size_t size() const { return truth.size(); }
};

struct AssociationOptions {
  double max_difference_s = 0.01;  ///< stamps farther apart are not paired
  double offset_s = 0;             ///< added to the estimate's stamps
};

/// For every pose of the shorter trajectory the nearest in time of the longer one (the earlier of two as
/// near), as evo pairs them: a pose of the longer one may serve twice, stamps are compared as double seconds.
/// @param truth, estimate  stamps never decrease
PosePairs associate_by_time(const slam::Trajectory& truth, const slam::Trajectory& estimate,
                            const AssociationOptions& options = {});

}  // namespace groundloop::bench
