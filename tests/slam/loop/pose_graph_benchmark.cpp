#include <benchmark/benchmark.h>

#include <numbers>

#include "slam/loop/pose_graph.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

/// Laps of a circle of 50 places, with links to the laps before: 150 nodes and 400 edges.
void solve_150_nodes_400_edges(benchmark::State& state) {
  constexpr int kNodes = 150, kEdges = 400, kLap = 50;
  const double turn_rad = 2 * std::numbers::pi / kLap;
  const Matrix6d covariance = 1e-5 * Matrix6d::Identity();
  const auto noisy = [&](const Pose& T, uint64_t counter) {
    Vector6d x;
    for (int i = 0; i < 6; ++i) x(i) = std::sqrt(1e-5) * gaussian(1, static_cast<uint64_t>(i), counter);
    return T * se3_exp(x);
  };
  std::vector<Pose> truth = {Pose::Identity()}, odometry = truth;
  const Pose step = se3_exp((Vector6d() << 0.4, 0, 0, 0, 0, turn_rad).finished());
  std::vector<PoseGraphEdge> edges;
  for (int k = 1; k < kNodes; ++k) {
    edges.push_back({k - 1, k, noisy(step, static_cast<uint64_t>(k)), covariance, false});
    truth.push_back(truth.back() * step);
    odometry.push_back(odometry.back() * edges.back().T_from_to);
  }
  for (uint64_t n = 0; static_cast<int>(edges.size()) < kEdges; ++n) {
    const int to = kLap + static_cast<int>(random_index(random_bits(2, 1, n), kNodes - kLap));
    const int from = std::max(0, to - kLap - 3 + static_cast<int>(random_index(random_bits(2, 2, n), 6)));
    const Pose T_from_to = truth[static_cast<size_t>(from)].inverse() * truth[static_cast<size_t>(to)];
    edges.push_back({from, to, noisy(T_from_to, 1000 + n), covariance, true});
  }
  std::vector<bool> fixed(kNodes, false);
  fixed[0] = true;
  PoseGraphSolution solution;
  for (auto _ : state) solution = solve_pose_graph(odometry, fixed, edges);
  if (!solution.usable) state.SkipWithError("not solved");
  state.counters["iterations"] = solution.iterations;
}
BENCHMARK(solve_150_nodes_400_edges)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
