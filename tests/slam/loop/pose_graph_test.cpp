#include "slam/loop/pose_graph.h"

#include <gtest/gtest.h>

#include <numbers>

#include "slam/adjustment/relative_pose.h"
#include "tests/slam/features/texture.h"

namespace groundloop::slam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

Pose planar(double x_m, double y_m, double yaw_rad) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp({0, 0, yaw_rad});
  T.translation() << x_m, y_m, 0;
  return T;
}

Matrix6d covariance_of(double sigma_m, double sigma_rad) {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variance.asDiagonal();
}

double difference(const Pose& a, const Pose& b) { return se3_log(a.inverse() * b).norm(); }

/// Normal deviate of the given covariance, which is diagonal.
Vector6d noise(const Matrix6d& covariance, uint64_t seed, uint64_t counter) {
  Vector6d x;
  for (int i = 0; i < 6; ++i) {
    x(i) = std::sqrt(covariance(i, i)) * gaussian(seed, static_cast<uint64_t>(i), counter);
  }
  return x;
}

struct Chain {
  std::vector<Pose> truth, odometry;
  std::vector<PoseGraphEdge> edges;
  std::vector<bool> fixed;
};

/// A drive along the given steps, measured with noise.
Chain drive(const std::vector<Pose>& steps, const Matrix6d& covariance, uint64_t seed) {
  Chain chain;
  chain.truth = chain.odometry = {Pose::Identity()};
  chain.fixed = {true};
  for (size_t k = 0; k < steps.size(); ++k) {
    const Pose measured = steps[k] * se3_exp(noise(covariance, seed, k));
    const int from = static_cast<int>(k);
    chain.truth.push_back(chain.truth.back() * steps[k]);
    chain.odometry.push_back(chain.odometry.back() * measured);
    chain.edges.push_back({from, from + 1, measured, covariance, false});
    chain.fixed.push_back(false);
  }
  return chain;
}

/// Steps around a square of 4 x 4 m, eight a side, back to the start.
std::vector<Pose> square() {
  std::vector<Pose> steps;
  for (int k = 0; k < 32; ++k) steps.push_back(planar(0.5, 0, k % 8 == 7 ? 90 * kDeg : 0));
  return steps;
}

TEST(PoseGraph, WhatAgreesStaysAsItIs) {
  const Chain chain = drive(square(), covariance_of(0, 0), 1);
  std::vector<PoseGraphEdge> edges = chain.edges;
  for (PoseGraphEdge& edge : edges) edge.covariance = covariance_of(0.01, 0.01);
  edges.push_back({0, 32, Pose::Identity(), covariance_of(0.01, 0.01), true});
  const PoseGraphSolution solution = solve_pose_graph(chain.truth, chain.fixed, edges);
  ASSERT_TRUE(solution.usable);
  EXPECT_LT(solution.cost, 1e-15);
  for (size_t k = 0; k < chain.truth.size(); ++k) {
    EXPECT_LT(difference(solution.T_map_node[k], chain.truth[k]), 1e-12);
  }
  EXPECT_EQ(solution.weight.size(), edges.size());
  EXPECT_NEAR(solution.weight.back(), 1, 1e-12);
}

// A single loop is closed by one step of the closed form: with P_0k the covariance of the pose of k as the
// chain has gathered it, expressed at the end of the loop n, and delta_n the correction that the loop asks
// there, delta_k = P_0k P_0n^-1 delta_n.
TEST(PoseGraph, ASingleLoopIsTheClosedFormOfPropagationBack) {
  std::vector<Pose> steps;
  for (int k = 0; k < 20; ++k) steps.push_back(planar(0.4, 0.02 * (k % 3), 16 * kDeg));
  const Matrix6d planar_noise =
      Vector6d((Vector6d() << 1e-4, 4e-5, 1e-12, 1e-12, 1e-12, 1e-4).finished()).asDiagonal();
  const Chain chain = drive(steps, covariance_of(0, 0), 1);
  std::vector<PoseGraphEdge> edges = chain.edges;
  for (PoseGraphEdge& edge : edges) edge.covariance = planar_noise;
  const size_t n = chain.truth.size() - 1;
  // So small that the closed form, which is of first order, is exact enough.
  const Vector6d delta_n = 1e-5 * (Vector6d() << 1.0, -2.0, 0, 0, 0, 0.7).finished();
  edges.push_back({0, static_cast<int>(n), chain.truth[n] * se3_exp(delta_n), 1e-12 * planar_noise, false});
  const PoseGraphSolution solution = solve_pose_graph(chain.truth, chain.fixed, edges);
  ASSERT_TRUE(solution.usable);

  std::vector<Matrix6d> P;  // of the pose of k, moved to n
  Matrix6d gathered = Matrix6d::Zero();
  for (size_t k = 0; k <= n; ++k) {
    const Matrix6d Ad = se3_adjoint(chain.truth[n].inverse() * chain.truth[k]);
    if (k > 0) gathered += Ad * planar_noise * Ad.transpose();
    P.push_back(gathered);
  }
  const Matrix6d P_n_inverse = P[n].inverse();
  for (size_t k = 0; k <= n; ++k) {
    const Vector6d delta_at_n = P[k] * P_n_inverse * delta_n;
    const Vector6d delta_k = se3_adjoint(chain.truth[k].inverse() * chain.truth[n]) * delta_at_n;
    const Vector6d found = se3_log(chain.truth[k].inverse() * solution.T_map_node[k]);
    EXPECT_LT((found - delta_k).norm(), 1e-3 * delta_n.norm()) << "node " << k;
  }
}

TEST(PoseGraph, ALoopTakesTheErrorOfASquareAway) {
  const Matrix6d step = covariance_of(0.01, 0.5 * kDeg), seen = covariance_of(0.001, 0.02 * kDeg);
  double before2 = 0, after2 = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Chain chain = drive(square(), step, seed);
    chain.edges.push_back({0, 32, chain.truth[32] * se3_exp(noise(seen, seed, 100)), seen, true});
    const PoseGraphSolution solution = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
    ASSERT_TRUE(solution.usable);
    EXPECT_LT(difference(solution.T_map_node[32], chain.truth[32]), 0.005);
    EXPECT_LT(solution.iterations, 20);
    for (size_t k = 0; k < chain.truth.size(); ++k) {
      before2 += (chain.odometry[k].translation() - chain.truth[k].translation()).squaredNorm();
      after2 += (solution.T_map_node[k].translation() - chain.truth[k].translation()).squaredNorm();
    }
  }
  EXPECT_LT(after2, 0.25 * before2);
}

// 31 steps of six residuals each determine nothing, the loop adds six: their sum of squares is chi-square.
TEST(PoseGraph, TheMisfitOfALoopIsChiSquare) {
  const Matrix6d step = covariance_of(0.005, 0.2 * kDeg), seen = covariance_of(0.001, 0.02 * kDeg);
  constexpr int kTrials = 200;
  double sum = 0;
  for (uint64_t seed = 1; seed <= kTrials; ++seed) {
    Chain chain = drive(square(), step, seed);
    chain.edges.push_back({0, 32, chain.truth[32] * se3_exp(noise(seen, seed, 100)), seen, false});
    const PoseGraphSolution solution = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
    ASSERT_TRUE(solution.usable);
    sum += solution.cost;
    double by_edge = 0;
    for (const double s : solution.squared_misfit) by_edge += s;
    EXPECT_NEAR(by_edge, solution.cost, 1e-9);
  }
  EXPECT_NEAR(sum / kTrials, 6, 1.96 * std::sqrt(12.0 / kTrials));
}

TEST(PoseGraph, AFalseLoopIsRejected) {
  const Matrix6d step = covariance_of(0.005, 0.2 * kDeg), seen = covariance_of(0.002, 0.05 * kDeg);
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    Chain chain = drive(square(), step, seed);
    const auto look = [&](int from, int to, const Pose& T_from_to) {
      const Vector6d e = noise(seen, seed, static_cast<uint64_t>(100 + to));
      chain.edges.push_back({from, to, T_from_to * se3_exp(e), seen, true});
    };
    look(0, 32, chain.truth[32]);
    look(0, 31, chain.truth[31]);
    const PoseGraphSolution without = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
    look(4, 20, planar(0.2, 0.1, 10 * kDeg));  // they are 4 m apart
    const PoseGraphSolution solution = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
    ASSERT_TRUE(solution.usable);
    EXPECT_LT(solution.weight.back(), 0.1);
    EXPECT_GT(solution.weight[32], 0.1);
    EXPECT_GT(solution.weight[33], 0.1);
    EXPECT_EQ(solution.weight[5], 1);  // a step may not be doubted
    for (size_t k = 0; k < chain.truth.size(); ++k) {
      EXPECT_LT(difference(solution.T_map_node[k], without.T_map_node[k]), 0.05) << "node " << k;
    }
  }
}

TEST(PoseGraph, ALaterSegmentMovesOntoTheOlderOneHoweverFarOffItIs) {
  const Matrix6d step = covariance_of(0.005, 0.2 * kDeg);
  Chain chain = drive(square(), step, 1);
  for (const double yaw_deg : {20.0, 90.0, 180.0}) {
    // Two segments: 0 to 15, and 16 to 32, which believes to be elsewhere. Each agrees with itself.
    std::vector<PoseGraphEdge> edges = chain.edges;
    edges.erase(edges.begin() + 15);
    std::vector<Pose> start = chain.odometry;
    const Pose lost = planar(7, -5, yaw_deg * kDeg);
    for (size_t k = 16; k < start.size(); ++k) start[k] = lost * start[k];
    const Pose T_from_to = chain.odometry[3].inverse() * chain.odometry[20];
    edges.push_back({3, 20, T_from_to, covariance_of(0.002, 0.05 * kDeg), true});
    const PoseGraphSolution solution = solve_pose_graph(start, chain.fixed, edges);
    ASSERT_TRUE(solution.usable);
    EXPECT_LT(solution.cost, 1e-9) << yaw_deg;
    for (size_t k = 0; k < start.size(); ++k) {
      EXPECT_LT(difference(solution.T_map_node[k], chain.odometry[k]), 1e-6) << yaw_deg << " deg, node " << k;
    }
  }
}

TEST(PoseGraph, SaysThatANodeHangsInTheAir) {
  const Chain chain = drive(square(), covariance_of(0.01, 0.01), 1);
  std::vector<PoseGraphEdge> edges = chain.edges;
  edges.erase(edges.begin() + 20);
  const PoseGraphSolution solution = solve_pose_graph(chain.odometry, chain.fixed, edges);
  EXPECT_FALSE(solution.usable);
  for (size_t k = 0; k < chain.truth.size(); ++k) {
    EXPECT_EQ(solution.T_map_node[k].matrix(), chain.odometry[k].matrix());
  }
}

TEST(PoseGraph, WithNothingFreeThereIsNothingToDo) {
  const Chain chain = drive({planar(1, 0, 0)}, covariance_of(0.01, 0.01), 1);
  const PoseGraphSolution solution = solve_pose_graph(chain.odometry, {true, true}, chain.edges);
  EXPECT_TRUE(solution.usable);
  EXPECT_EQ(solution.squared_misfit.size(), 1u);
  EXPECT_TRUE(solve_pose_graph({}, {}, {}).usable);
}

TEST(PoseGraph, SameGraphSameBits) {
  Chain chain = drive(square(), covariance_of(0.01, 0.01), 3);
  chain.edges.push_back({0, 32, Pose::Identity(), covariance_of(0.001, 0.001), true});
  const PoseGraphSolution a = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
  const PoseGraphSolution b = solve_pose_graph(chain.odometry, chain.fixed, chain.edges);
  for (size_t k = 0; k < a.T_map_node.size(); ++k) {
    EXPECT_EQ(a.T_map_node[k].matrix(), b.T_map_node[k].matrix());
  }
}

}  // namespace
}  // namespace groundloop::slam
