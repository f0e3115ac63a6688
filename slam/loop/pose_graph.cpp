#include "slam/loop/pose_graph.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/adjustment/relative_pose.h"

namespace groundloop::slam {
namespace {

constexpr double kScale2 = 12.59;  // of the Lorentzian: 95 % of true edges lie below (chi-square, 6)
constexpr int kMaxIterations = 50;
constexpr double kConverged_m = 1e-7;  // longest step, metres and radians
constexpr double kConverged = 1e-6;    // decrease of the cost, relative to it
constexpr double kFirstDamping = 1e-8, kLeastDamping = 1e-12, kMostDamping = 1e6;

/// Normal equations of the free nodes: sparse, of constant pattern, lower triangle only.
class NormalEquations {
 public:
  NormalEquations(const std::vector<int>& row, int unknowns, const std::vector<PoseGraphEdge>& edges)
      : row_(row), edges_(edges), H_(unknowns, unknowns), g_(unknowns) {
    for (const PoseGraphEdge& edge : edges_) {
      information_.push_back(edge.covariance.ldlt().solve(Matrix6d::Identity()));
    }
  }

  /// Squared misfits and weights at the given poses. @return the cost
  double measure(PoseGraphSolution& solution) const {
    solution.squared_misfit.clear();
    solution.weight.clear();
    double cost = 0;
    for (size_t i = 0; i < edges_.size(); ++i) {
      const Vector6d e = misfit(solution.T_map_node, i).error;
      const double s = e.dot(information_[i] * e);
      const bool robust = edges_[i].robust;
      solution.squared_misfit.push_back(s);
      solution.weight.push_back(robust ? 1 / (1 + s / kScale2) : 1);
      cost += robust ? kScale2 * std::log1p(s / kScale2) : s;
    }
    return cost;
  }

  void linearise(const PoseGraphSolution& solution) {
    entries_.clear();
    g_.setZero();
    for (size_t i = 0; i < edges_.size(); ++i) {
      const RelativePoseError e = misfit(solution.T_map_node, i);
      const Matrix6d W = solution.weight[i] * information_[i];
      const int row[2] = {row_[edges_[i].from], row_[edges_[i].to]};
      const Matrix6d* const J[2] = {&e.J_from, &e.J_to};
      for (int a = 0; a < 2; ++a) {
        if (row[a] < 0) continue;
        const Matrix6d JtW = J[a]->transpose() * W;
        g_.segment<6>(row[a]) -= JtW * e.error;
        for (int b = 0; b < 2; ++b) {
          if (row[b] >= 0 && row[b] <= row[a]) add(row[a], row[b], JtW * *J[b]);
        }
      }
    }
    H_.setFromTriplets(entries_.begin(), entries_.end());
    diagonal_ = H_.diagonal();
  }

  /// Step that decreases the cost; empty when there is none.
  Eigen::VectorXd solve(double damping) {
    if (!factorise(damping)) return {};
    return factor_.solve(g_);
  }

  bool factorise(double damping) {
    H_.diagonal() = (1 + damping) * diagonal_;
    if (!analysed_) factor_.analyzePattern(H_);
    analysed_ = true;
    factor_.factorize(H_);
    return factor_.info() == Eigen::Success;
  }

 private:
  RelativePoseError misfit(const std::vector<Pose>& T_map_node, size_t i) const {
    return relative_pose_error(T_map_node[edges_[i].from], T_map_node[edges_[i].to], edges_[i].T_from_to);
  }
  void add(int row, int column, const Matrix6d& block) {
    for (int c = 0; c < 6; ++c) {
      for (int r = row == column ? c : 0; r < 6; ++r) {
        entries_.emplace_back(row + r, column + c, block(r, c));
      }
    }
  }

  const std::vector<int>& row_;
  const std::vector<PoseGraphEdge>& edges_;
  std::vector<Matrix6d> information_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::SparseMatrix<double> H_;
  Eigen::VectorXd g_, diagonal_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool analysed_ = false;
};

/// Whether edges lead from every node to a fixed one.
bool anchored(const std::vector<bool>& fixed, const std::vector<PoseGraphEdge>& edges) {
  std::vector<bool> held = fixed;
  for (bool grows = true; grows;) {
    grows = false;
    for (const PoseGraphEdge& edge : edges) {
      if (held[edge.from] == held[edge.to]) continue;
      held[edge.from] = held[edge.to] = grows = true;
    }
  }
  return std::find(held.begin(), held.end(), false) == held.end();
}

/// Per node the first of its six unknowns, -1 for a fixed one; and how many there are.
std::pair<std::vector<int>, int> rows_of(const std::vector<bool>& fixed) {
  std::vector<int> row(fixed.size(), -1);
  int unknowns = 0;
  for (size_t i = 0; i < row.size(); ++i) {
    if (fixed[i]) continue;
    row[i] = unknowns;
    unknowns += 6;
  }
  return {row, unknowns};
}

std::vector<Pose> moved(const std::vector<Pose>& T_map_node, const std::vector<int>& row,
                        const Eigen::VectorXd& step) {
  std::vector<Pose> out = T_map_node;
  for (size_t i = 0; i < row.size(); ++i) {
    if (row[i] >= 0) out[i] = out[i] * se3_exp(step.segment<6>(row[i]));
  }
  return out;
}

}  // namespace

PoseGraphSolution solve_pose_graph(const std::vector<Pose>& T_map_node, const std::vector<bool>& fixed,
                                   const std::vector<PoseGraphEdge>& edges) {
  PoseGraphSolution best;
  best.T_map_node = T_map_node;
  const auto [row, unknowns] = rows_of(fixed);
  NormalEquations equations(row, unknowns, edges);
  best.cost = equations.measure(best);
  if (!anchored(fixed, edges)) return best;
  if (unknowns > 0) equations.linearise(best);
  double damping = kFirstDamping;
  while (unknowns > 0 && best.iterations < kMaxIterations && damping < kMostDamping) {
    ++best.iterations;
    const Eigen::VectorXd step = equations.solve(damping);
    if (step.size() == 0 || !step.allFinite()) {
      best.T_map_node = T_map_node;
      best.cost = equations.measure(best);
      return best;
    }
    PoseGraphSolution next = best;
    next.T_map_node = moved(best.T_map_node, row, step);
    next.cost = equations.measure(next);
    const bool converged =
        step.cwiseAbs().maxCoeff() < kConverged_m || std::abs(best.cost - next.cost) < kConverged * best.cost;
    if (next.cost <= best.cost) {
      best = std::move(next);
      damping = std::max(0.1 * damping, kLeastDamping);
      if (!converged) equations.linearise(best);
    } else {
      damping *= 100;
    }
    if (converged) break;
  }
  for (size_t i = 0; i < row.size(); ++i) {
    if (row[i] >= 0) best.T_map_node[i] = renormalised(best.T_map_node[i]);
  }
  best.usable = true;
  return best;
}

}  // namespace groundloop::slam
