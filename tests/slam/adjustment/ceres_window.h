#pragma once

#include "slam/adjustment/adjustment_problem.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// The cost of WindowAdjustment, minimised by Ceres (dense Schur, one thread): poses, landmarks, and the
/// motion of each key frame's covariance left empty.
/// @param tolerance  of the cost, relative; 0: until nothing moves or max_iterations
AdjustmentResult ceres_window(const StereoRig& rig, const AdjustmentOptions& options,
                              const AdjustmentProblem& problem, double tolerance);

}  // namespace groundloop::slam
