#include "slam/loop/place_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "slam/adjustment/relative_pose.h"
#include "slam/loop/pose_graph.h"

namespace groundloop::slam {
namespace {

constexpr int kEdgesBetweenTwoPlaces = 3;  // newest ones kept, so that memory stays bounded
/// Increase of the graph's cost from which a recognition counts as contradicted: six degrees of freedom would
/// give 22 in one of a thousand, and covariances may be too small by two.
constexpr double kContradiction = 50;
/// Added to the covariance of every edge (0.1 mm, 0.1 mrad): what no model of noise knows.
const Matrix6d kFloor = 1e-8 * Matrix6d::Identity();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Covariance of T_a_b T_b_c from those of the two.
Matrix6d chained(const Matrix6d& covariance_b, const Pose& T_b_c, const Matrix6d& covariance_c) {
  const Matrix6d Ad = se3_adjoint(T_b_c.inverse());
  return Ad * covariance_b * Ad.transpose() + covariance_c;
}

RelativeMotion inverse(const RelativeMotion& motion) {
  const Matrix6d Ad = se3_adjoint(motion.T_from_to);
  return {motion.T_from_to.inverse(), Ad * motion.covariance * Ad.transpose()};
}

/// Where a key frame stands at a place, of what was seen there and what was known before.
Tie fused(const Tie& seen, const RelativeMotion& known) {
  const Matrix6d gain = known.covariance * (known.covariance + seen.covariance).inverse();
  const Vector6d innovation = se3_log(known.T_from_to.inverse() * seen.T_place_left);
  Tie tie = seen;
  tie.T_place_left = renormalised(known.T_from_to * se3_exp(gain * innovation));
  tie.covariance = known.covariance - gain * known.covariance;
  tie.covariance = 0.5 * (tie.covariance + tie.covariance.transpose()).eval();
  return tie;
}

RelativeMotion motion_of(const Tie& tie) { return {tie.T_place_left, tie.covariance}; }

}  // namespace

RelativeMotion operator*(const RelativeMotion& a, const RelativeMotion& b) {
  return {a.T_from_to * b.T_from_to, chained(a.covariance, b.T_from_to, b.covariance)};
}

void PlaceMap::advance(const OdometryPose& newest, std::span<const OdometryPose> known_better) {
  path_.push_back(newest);
  tie_of_.push_back(tie());
  refine(known_better);
}

void PlaceMap::refine(std::span<const OdometryPose> known_better) {
  for (const OdometryPose& pose : known_better) path_[pose.key_frame] = pose;
  follow_odometry();
}

void PlaceMap::hang_on(const Tie& tie) {
  ties_.push_back(tie);
  tie_of_.back() = this->tie();
  spread_.key_frame = -1;
}

void PlaceMap::start(const Pose& T_map_left) {
  const int place = places();
  T_map_place_.push_back(T_map_left);
  component_.push_back(place);
  key_frame_of_place_.push_back(path_.back().key_frame);
  hang_on({place, path_.back().key_frame, Pose::Identity(), Matrix6d::Zero()});
}

void PlaceMap::add_place() {
  const Tie tie{places(), path_.back().key_frame, Pose::Identity(), Matrix6d::Zero()};
  T_map_place_.push_back(T_map_left(tie.key_frame));
  component_.push_back(component_[ties_.back().place]);
  key_frame_of_place_.push_back(tie.key_frame);
  add_edge({ties_.back(), tie, false});
  hang_on(tie);
}

bool PlaceMap::recognise(const Tie& seen, bool becomes_place) {
  if (becomes_place) {
    add_place();
    return join({seen, ties_.back(), true});
  }
  // Odometry's say counts too: a place seen from afar tells less than the last steps do.
  const std::optional<RelativeMotion> known = relative(key_frame_of_place_[seen.place], seen.key_frame);
  if (ties_.back().place != seen.place && !join({ties_.back(), seen, true})) return false;
  hang_on(known ? fused(seen, *known) : seen);
  return true;
}

/// Adds an edge that may be wrong, and corrects the map by it; false when the map contradicts it.
bool PlaceMap::join(const Edge& edge) {
  std::vector<Pose> T_map_place = T_map_place_;
  move_component(edge, T_map_place);
  if (!solve(edge, T_map_place)) return false;
  T_map_place_ = std::move(T_map_place);
  add_edge(edge);
  const int from = component_[edge.from.place], to = component_[edge.to.place];
  std::replace(component_.begin(), component_.end(), std::max(from, to), std::min(from, to));
  spread_.key_frame = -1;
  return true;
}

/// Where an edge joins two parts of the map, the younger one moves to the older one as a whole.
void PlaceMap::move_component(const Edge& edge, std::vector<Pose>& T_map_place) const {
  const int from = component_[edge.from.place], to = component_[edge.to.place];
  if (from == to) return;
  const Pose T_from_to = motion(edge).T_from_to;
  const Pose &T_map_from = T_map_place_[edge.from.place], &T_map_to = T_map_place_[edge.to.place];
  const Pose correction = from > to ? T_map_to * T_from_to.inverse() * T_map_from.inverse()
                                    : T_map_from * T_from_to * T_map_to.inverse();
  for (int i = 0; i < places(); ++i) {
    if (component_[i] == std::max(from, to)) T_map_place[i] = correction * T_map_place[i];
  }
}

/// Poses of all places with a new edge believed, or false when the others cannot live with it.
bool PlaceMap::solve(const Edge& newest, std::vector<Pose>& T_map_place) const {
  std::vector<PoseGraphEdge> edges;
  const auto add = [&](const Edge& edge, bool robust) {
    const RelativeMotion measured = motion(edge);
    edges.push_back(
        {edge.from.place, edge.to.place, measured.T_from_to, measured.covariance + kFloor, robust});
  };
  for (const Edge& edge : edges_) add(edge, edge.recognised);
  std::vector<bool> fixed(T_map_place.size());
  for (int i = 0; i < places(); ++i) fixed[i] = component_[i] == i;
  const double cost_before = solve_pose_graph(T_map_place, fixed, edges).cost;
  // Two parts that the new edge joins keep one fixed place.
  fixed[std::max(component_[newest.from.place], component_[newest.to.place])] =
      component_[newest.from.place] == component_[newest.to.place];
  add(newest, false);
  PoseGraphSolution solution = solve_pose_graph(T_map_place, fixed, edges);
  if (!solution.usable || solution.cost - cost_before > kContradiction) return false;
  T_map_place = std::move(solution.T_map_node);
  return true;
}

void PlaceMap::add_edge(const Edge& edge) {
  const auto same = [&edge](const Edge& e) {
    return std::minmax(e.from.place, e.to.place) == std::minmax(edge.from.place, edge.to.place);
  };
  if (std::count_if(edges_.begin(), edges_.end(), same) >= kEdgesBetweenTwoPlaces) {
    edges_.erase(std::find_if(edges_.begin(), edges_.end(), same));
  }
  edges_.push_back(edge);
}

RelativeMotion PlaceMap::odometry(int from_key_frame, int to_key_frame) const {
  RelativeMotion motion;
  for (int k = from_key_frame + 1; k <= to_key_frame; ++k) {
    const Pose T_step = path_[k - 1].T_odom_left.inverse() * path_[k].T_odom_left;
    motion.covariance = chained(motion.covariance, T_step, path_[k].covariance);
  }
  motion.T_from_to = path_[from_key_frame].T_odom_left.inverse() * path_[to_key_frame].T_odom_left;
  return motion;
}

RelativeMotion PlaceMap::motion(const Edge& edge) const {
  return motion_of(edge.from) * odometry(edge.from.key_frame, edge.to.key_frame) *
         inverse(motion_of(edge.to));
}

/// Places that only odometry has reached are where odometry now says.
void PlaceMap::follow_odometry() {
  // The last recognition has fixed all that came before it.
  size_t first = edges_.size();
  while (first > 0 && !edges_[first - 1].recognised) --first;
  for (size_t i = first; i < edges_.size(); ++i) {
    T_map_place_[edges_[i].to.place] = T_map_place_[edges_[i].from.place] * motion(edges_[i]).T_from_to;
  }
  spread_.key_frame = -1;
}

Tie PlaceMap::standing(int key_frame) const {
  const Tie& tie = ties_[tie_of_[key_frame]];
  const RelativeMotion motion = motion_of(tie) * odometry(tie.key_frame, key_frame);
  return {tie.place, key_frame, motion.T_from_to, motion.covariance};
}

Pose PlaceMap::T_map_left(int key_frame) const {
  const Tie tie = standing(key_frame);
  return T_map_place_[tie.place] * tie.T_place_left;
}

std::vector<Pose> PlaceMap::T_map_odom() const {
  std::vector<Pose> T_map_odom;
  T_map_odom.reserve(ties_.size());
  for (const Tie& tie : ties_) {
    T_map_odom.push_back(T_map_place_[tie.place] * tie.T_place_left *
                         path_[tie.key_frame].T_odom_left.inverse());
  }
  return T_map_odom;
}

std::optional<RelativeMotion> PlaceMap::relative(int from_key_frame, int to_key_frame) {
  const Tie from = standing(from_key_frame), to = standing(to_key_frame);
  if (component_[from.place] != component_[to.place]) return std::nullopt;
  if (tie_of_[from_key_frame] == tie_of_[to_key_frame] && from_key_frame <= to_key_frame) {
    return odometry(from_key_frame, to_key_frame);
  }
  if (spread_.key_frame != to_key_frame) spread_from(to_key_frame);
  const Pose T_place_to = T_map_place_[from.place].inverse() * T_map_place_[to.place] * to.T_place_left;
  return inverse(motion_of(from)) * RelativeMotion{T_place_to, spread_.covariance[from.place]};
}

/// Dijkstra's search outwards from a key frame, by the trace over translations.
void PlaceMap::spread_from(int key_frame) {
  const Tie start = standing(key_frame);
  spread_.key_frame = key_frame;
  std::vector<Matrix6d>& covariance = spread_.covariance;
  covariance.assign(T_map_place_.size(), Matrix6d::Zero());
  std::vector<double> cost(T_map_place_.size(), kInfinity);
  std::vector<uint8_t> done(T_map_place_.size(), 0);
  const auto reach = [&](int place, const Matrix6d& reached) {
    const double trace = reached.topLeftCorner<3, 3>().trace();
    if (done[place] != 0 || trace >= cost[place]) return;
    cost[place] = trace;
    covariance[place] = reached;
  };
  std::vector<RelativeMotion> motions;
  for (const Edge& edge : edges_) motions.push_back(motion(edge));
  reach(start.place, start.covariance);
  for (;;) {
    int here = -1;
    double least = kInfinity;
    for (int i = 0; i < places(); ++i) {
      if (done[i] == 0 && cost[i] < least) least = cost[here = i];
    }
    if (here < 0) return;
    done[here] = 1;
    const RelativeMotion newest{T_map_place_[here].inverse() * T_map_place_[start.place] * start.T_place_left,
                                covariance[here]};
    for (size_t i = 0; i < edges_.size(); ++i) {
      const int from = edges_[i].from.place, to = edges_[i].to.place;
      if (to == here) reach(from, (motions[i] * newest).covariance);
      if (from == here) reach(to, (inverse(motions[i]) * newest).covariance);
    }
  }
}

}  // namespace groundloop::slam
