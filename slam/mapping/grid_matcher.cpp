#include "slam/mapping/grid_matcher.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "slam/mapping/correlative_search.h"
#include "slam/mapping/occupied_field.h"
#include "slam/types/counter_random.h"

namespace groundloop::slam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The occupied cells of a map about their centre.
struct OccupiedCells {
  explicit OccupiedCells(const OccupancyMap& map);

  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  std::vector<WeightedPoint> points;
  double weight = 0;   ///< sum
  double reach_m = 0;  ///< root mean square distance from the centre
};

OccupiedCells::OccupiedCells(const OccupancyMap& map) {
  const GridGeometry& grid = map.geometry;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const float value = map.at(col, row);
      if (value > OccupancyMap::kOccupiedAbove) points.push_back({grid.centre_m(col, row), 2 * value - 1.0});
    }
  }
  for (const WeightedPoint& point : points) weight += point.weight, centre_m += point.weight * point.p_m;
  if (points.empty()) return;
  centre_m /= weight;
  for (WeightedPoint& point : points) {
    point.p_m -= centre_m;
    reach_m += point.weight * point.p_m.squaredNorm();
  }
  reach_m = std::sqrt(reach_m / weight);
}

/// About so many of the points, drawn without regard to the lattice they lie on: enough for the search.
std::vector<WeightedPoint> thinned(const std::vector<WeightedPoint>& points, size_t wanted) {
  std::vector<WeightedPoint> some;
  for (size_t i = 0; i < points.size(); ++i) {
    if (random_index(random_bits(0, 0, i), static_cast<uint32_t>(points.size())) < wanted) {
      some.push_back(points[i]);
    }
  }
  return some;
}

/// A placement of the cells: their centre in the global map [m], and their heading times their reach [m], so
/// that all three are displacements of cells.
using Placement = Eigen::Vector3d;

/// The score of a placement with its derivatives.
class AlignmentScore {
 public:
  AlignmentScore(const OccupiedField& field, const OccupiedCells& cells) : field_(field), cells_(cells) {}

  double value(const Placement& x) const;
  double derivatives(const Placement& x, Eigen::Vector3d& gradient, Eigen::Matrix3d& hessian) const;
  double weight() const { return cells_.weight; }

 private:
  const OccupiedField& field_;
  const OccupiedCells& cells_;
};

double AlignmentScore::value(const Placement& x) const {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(x.z() / cells_.reach_m).toRotationMatrix();
  double sum = 0;
  for (const WeightedPoint& point : cells_.points) {
    sum += point.weight * field_.value(x.head<2>() + R * point.p_m);
  }
  return sum;
}

double AlignmentScore::derivatives(const Placement& x, Eigen::Vector3d& gradient,
                                   Eigen::Matrix3d& hessian) const {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(x.z() / cells_.reach_m).toRotationMatrix();
  gradient.setZero(), hessian.setZero();
  double sum = 0;
  for (const WeightedPoint& point : cells_.points) {
    const Eigen::Vector2d arm = R * point.p_m;
    const OccupiedField::Jet jet = field_.jet(x.head<2>() + arm);
    const Eigen::Vector2d swing = Eigen::Vector2d(-arm.y(), arm.x()) / cells_.reach_m;
    Eigen::Matrix<double, 2, 3> J;  // of the point by the placement
    J << Eigen::Matrix2d::Identity(), swing;
    sum += point.weight * jet.value;
    gradient += point.weight * J.transpose() * jet.gradient;
    hessian += point.weight * J.transpose() * jet.hessian * J;
    hessian(2, 2) -= point.weight * jet.gradient.dot(arm) / (cells_.reach_m * cells_.reach_m);
  }
  return sum;
}

/// Climbs to the summit by Newton steps, damped where the score is not concave (Levenberg-Marquardt).
Placement summit(const AlignmentScore& score, Placement x) {
  constexpr int kIterations = 20;
  constexpr double kConverged_m = 1e-5;
  double damping = 1e-3;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  double height = score.derivatives(x, gradient, hessian);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(-hessian);
    const Eigen::Vector3d curvature = axes.eigenvalues().cwiseAbs();
    const Eigen::Vector3d damped = curvature.array() + damping * curvature.maxCoeff() + 1e-12;
    const Eigen::Vector3d step =
        axes.eigenvectors() * (axes.eigenvectors().transpose() * gradient).cwiseQuotient(damped);
    const double higher = score.value(x + step);
    if (higher < height) {
      damping = std::max(1e-3, 4 * damping);
      if (damping > 1e6) break;
      continue;
    }
    x += step;
    if (step.norm() < kConverged_m) break;
    damping /= 4;
    height = score.derivatives(x, gradient, hessian);
  }
  return x;
}

/// Weight of a score as log-likelihood. Neighbouring cells err together (the same wall, seen from the same
/// side), so a map counts as this many cells, however many it has; the number makes the mean NEES about right
/// over the maps of 10 to 20 key frames that the tests draw.
constexpr double kIndependentCells = 600;

/// Covariance of the placement from the shape of the score around its summit: the second moment of its
/// likelihood over a lattice along the axes of the curvature there, three deviations to every side.
/// @param half  of the search window, where nothing beyond was looked at
Eigen::Matrix3d spread(const AlignmentScore& score, const Placement& x, const Eigen::Vector3d& half) {
  const double likelihood_scale = kIndependentCells / score.weight();
  constexpr double kStep = 1.5;  // five of them give the second moment of a Gaussian to 1 %
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  const double height = score.derivatives(x, gradient, hessian);
  const Eigen::Matrix3d within_window = half.cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(-likelihood_scale * hessian + within_window);
  const Eigen::Vector3d curvature = axes.eigenvalues().cwiseMax(within_window.diagonal().minCoeff());
  const Eigen::Matrix3d deviations = axes.eigenvectors() * curvature.cwiseSqrt().cwiseInverse().asDiagonal();

  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  double total = 0;
  for (int a = -2; a <= 2; ++a) {
    for (int b = -2; b <= 2; ++b) {
      for (int c = -2; c <= 2; ++c) {
        const Eigen::Vector3d offset = kStep * deviations * Eigen::Vector3d(a, b, c);
        const double likelihood = std::exp(likelihood_scale * (score.value(x + offset) - height));
        moment += likelihood * offset * offset.transpose();
        total += likelihood;
      }
    }
  }
  return moment / total;
}

/// How the local frame's own perturbation (x, y, yaw) moves a point of it, in the frame's axes, and the
/// heading.
Eigen::Matrix3d to_point(const Eigen::Vector2d& p_local) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topRightCorner<2, 1>() << -p_local.y(), p_local.x();
  return J;
}

double heading_rad(const Eigen::Isometry2d& T) { return Eigen::Rotation2Dd(T.linear()).angle(); }

Eigen::Matrix3d turned(const Eigen::Matrix2d& R, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by.topLeftCorner<2, 2>() = R;
  return by * covariance * by.transpose();
}

SearchWindow window_of(const OccupiedCells& cells, const PlanarPose& prior, const MapMatchOptions& options,
                       double cell_m) {
  constexpr double kLeastCells = 3;  // narrower, the summit itself would be cut off
  const Eigen::Matrix2d R = prior.T_global_local.linear();
  const Eigen::Matrix3d J = to_point(cells.centre_m);
  const Eigen::Vector3d sigma =
      turned(R, J * prior.covariance * J.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  const auto half = [&](double deviation, double most, double least) {
    return std::max(least, std::min(most, options.search_sigma * deviation));
  };
  SearchWindow window;
  window.centre_m = prior.T_global_local * cells.centre_m;
  window.yaw_rad = heading_rad(prior.T_global_local);
  for (int i = 0; i < 2; ++i) {
    window.half_m[i] = half(sigma[i], options.max_window_m, kLeastCells * cell_m);
  }
  window.half_rad = half(sigma.z(), options.max_window_deg * kDegree, kLeastCells * cell_m / cells.reach_m);
  return window;
}

/// What the global map says of the places where the local map's occupied cells came to lie.
void compare(const OccupancyMap& global, const OccupiedCells& cells, const Placement& x, MapMatch& match) {
  const GridGeometry& grid = global.geometry;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(x.z() / cells.reach_m).toRotationMatrix();
  double known = 0, occupied = 0;
  for (const WeightedPoint& point : cells.points) {
    const Eigen::Vector2d p_m = x.head<2>() + R * point.p_m;
    float highest = 0;
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector2d near_m = p_m + Eigen::Vector2d(i % 3 - 1, i / 3 - 1) * grid.cell_m;
      highest = std::max(highest, global.at_point(near_m.x(), near_m.y()));
    }
    const bool is_occupied = highest > OccupancyMap::kOccupiedAbove;
    const float here = global.at_point(p_m.x(), p_m.y());
    if (is_occupied || here < OccupancyMap::kFreeBelow) known += point.weight;
    if (is_occupied) occupied += point.weight;
  }
  match.overlap = known / cells.weight;
  match.agreement = known > 0 ? occupied / known : 0;
}

/// The direction in the local frame in which the position is known worst, and how well.
std::string worst_direction(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  return fmt::format("the position is known to {:.3f} m only along ({:.2f}, {:.2f}) of the local map",
                     std::sqrt(axes.eigenvalues()[1]), along.x(), along.y());
}

/// Reason why a place is not a match; empty when it is one.
std::string refusal(const MapMatch& match, bool at_edge, const MapMatchOptions& options) {
  if (match.overlap < options.min_overlap) {
    return fmt::format("not enough structure: the global map knows {:.0f} % of the local one's cells",
                       100 * match.overlap);
  }
  if (match.agreement < options.min_agreement) {
    return fmt::format("the maps disagree: {:.0f} % of the occupied cells are occupied in both",
                       100 * match.agreement);
  }
  if (match.second_score > options.max_second_score) {
    return fmt::format("not enough structure: another place fits {:.0f} % as well", 100 * match.second_score);
  }
  const Eigen::Matrix3d& C = match.pose.covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(C.topLeftCorner<2, 2>());
  if (axes.eigenvalues()[1] > options.max_sigma_m * options.max_sigma_m) {
    return "not enough structure: " + worst_direction(C);
  }
  if (const double sigma_deg = std::sqrt(C(2, 2)) / kDegree; sigma_deg > options.max_sigma_deg) {
    return fmt::format("not enough structure: the heading is known to {:.2f} deg only", sigma_deg);
  }
  if (at_edge) return "the best place is at the edge of the search window";
  return {};
}

/// A placement of the cells and its covariance as a pose of the local frame.
PlanarPose pose_of_local(const OccupiedCells& cells, const Placement& x, const Eigen::Matrix3d& covariance) {
  const Eigen::Rotation2Dd R(x.z() / cells.reach_m);
  PlanarPose pose;
  pose.T_global_local.linear() = R.toRotationMatrix();
  pose.T_global_local.translation() = x.head<2>() - R * cells.centre_m;
  const Eigen::DiagonalMatrix<double, 3> to_heading(1, 1, 1 / cells.reach_m);
  const Eigen::Matrix3d of_centre =
      turned(R.inverse().toRotationMatrix(), to_heading * covariance * to_heading);
  const Eigen::Matrix3d to_origin = to_point(cells.centre_m).inverse();
  pose.covariance = to_origin * of_centre * to_origin.transpose();
  return pose;
}

/// Goes from the search's best place to the summit, and says how good it is.
void refine(const OccupancyMap& global, const OccupancyMap& local, const OccupiedCells& cells,
            const SearchWindow& window, const SearchPeak& best, MapMatch& match) {
  double farthest_m = 0;
  for (const WeightedPoint& point : cells.points) farthest_m = std::max(farthest_m, point.p_m.norm());
  const Eigen::Vector2d around_m = Eigen::Vector2d::Constant(farthest_m) + 2 * window.half_m;
  const OccupiedField field(global, window.centre_m - around_m, window.centre_m + around_m);
  const AlignmentScore score(field, cells);
  const Placement x = summit(score, {best.centre_m.x(), best.centre_m.y(), best.yaw_rad * cells.reach_m});
  const Eigen::Vector3d half(window.half_m.x(), window.half_m.y(), window.half_rad * cells.reach_m);
  match.pose = pose_of_local(cells, x, spread(score, x, half));

  const OccupiedField own_field(local, cells.centre_m - around_m, cells.centre_m + around_m);
  const AlignmentScore own_score(own_field, cells);
  match.score = score.value(x) / own_score.value({cells.centre_m.x(), cells.centre_m.y(), 0});
  compare(global, cells, x, match);
}

}  // namespace

MapMatch match_maps(const OccupancyMap& global, const OccupancyMap& local, const PlanarPose& prior,
                    const MapMatchOptions& options) {
  constexpr size_t kSearchPoints = 600;
  MapMatch match;
  match.pose = prior;
  const OccupiedCells cells(local);
  match.cells = static_cast<int>(cells.points.size());
  if (match.cells < options.min_cells) {
    match.message =
        fmt::format("not enough structure: {} occupied cells, {} are needed", match.cells, options.min_cells);
    return match;
  }
  const double cell_m = global.geometry.cell_m;
  const SearchWindow window = window_of(cells, prior, options, cell_m);
  const Separation separation{4 * cell_m, 4 * cell_m / cells.reach_m};
  const SearchResult found = search_peaks(global, thinned(cells.points, kSearchPoints), window, separation);
  if (!(found.best.score > 0)) {
    match.message = "not enough structure: nothing of the global map is occupied there";
    return match;
  }
  if (found.second) match.second_score = found.second->score / found.best.score;
  refine(global, local, cells, window, found.best, match);
  match.message = refusal(match, found.at_edge, options);
  match.accepted = match.message.empty();
  return match;
}

}  // namespace groundloop::slam
