#pragma once

#include <vector>

#include "slam/types/pose.h"

namespace groundloop::slam {

/// A measured relative pose between two nodes.
struct PoseGraphEdge {
  int from = 0, to = 0;
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< right perturbation in `to`
  bool robust = false;                         ///< may be wrong: loses weight as it contradicts the others
};

/// Weight below which a robust edge counts as wrong.
constexpr double kRejected = 0.1;

/// Where the edges pull the nodes.
struct PoseGraphSolution {
  bool usable = false;  ///< false: the edges do not determine the nodes, poses are those given
  std::vector<Pose> T_map_node;
  std::vector<double> squared_misfit;  ///< per edge: e^T C^-1 e, six degrees of freedom
  std::vector<double> weight;  ///< per edge, 1 if not robust: below kRejected the others contradict it
  double cost = 0;             ///< sum over edges of squared_misfit, robust ones by the Lorentzian
  int iterations = 0;
};

/// Minimises the misfits of all edges, e = log(T_from_to^-1 T_map_from^-1 T_map_to) in standard deviations;
/// robust edges by k^2 log(1 + s / k^2). Levenberg-Marquardt on reweighted sparse normal equations. An error
/// that shows at a loop is so spread over the edges of the path by their covariances, which for a single loop
/// is one step of the propagation back along the path: delta_k = P_0k P_0n^-1 delta_n
/// (docs/paper-to-code.md).
///
/// @param fixed  per node; at least one in every connected part
PoseGraphSolution solve_pose_graph(const std::vector<Pose>& T_map_node, const std::vector<bool>& fixed,
                                   const std::vector<PoseGraphEdge>& edges);

}  // namespace groundloop::slam
