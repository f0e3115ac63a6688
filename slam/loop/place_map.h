#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/types/pose.h"

namespace groundloop::slam {

/// A key frame as odometry knows it.
struct OdometryPose {
  int key_frame = 0;  ///< counts from 0
  Pose T_odom_left = Pose::Identity();
  Matrix6d covariance =
      Matrix6d::Zero();  ///< of the motion from the key frame before, right perturbation in this one
};

/// A key frame and where it stands at a place.
struct Tie {
  int place = 0;
  int key_frame = 0;
  Pose T_place_left = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_place_left, right perturbation
};

/// A measured or derived relative pose.
struct RelativeMotion {
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< right perturbation in `to`
};

/// One motion after the other, of independent errors.
RelativeMotion operator*(const RelativeMotion& a, const RelativeMotion& b);

/// Places of the map, joined by what odometry and recognition measured between them.
///
/// A place is a key frame that is kept. Odometry goes on from the tie: where the robot was last known to
/// stand at a place. When a key frame is recognised to stand at another place, an edge joins the two and the
/// tie moves over; so a known area gets no second set of places, and memory grows with the area. What the
/// edges disagree about is spread over them by a pose graph, robust against a wrong recognition: the gathered
/// error goes back along the path that gathered it.
///
/// All that hangs on the path follows by its tie: T_map_left = T_map_odom()[tie] T_odom_left.
class PlaceMap {
 public:
  /// Takes in the newest key frame.
  /// @param known_better  earlier key frames whose pose was refined meanwhile
  void advance(const OdometryPose& newest, std::span<const OdometryPose> known_better);
  /// Takes over refined poses when no key frame follows.
  void refine(std::span<const OdometryPose> known_better);

  /// Makes the newest key frame a place with no edge to another: the first, or the first after a loss of
  /// track.
  void start(const Pose& T_map_left);
  /// Makes the newest key frame a place, reached by odometry from the tie.
  void add_place();
  /// The newest key frame was recognised to stand somewhere at a place. Corrects the whole map, and where the
  /// newest key frame stands, each by what it was known to before.
  /// @param seen          its key frame is the newest one
  /// @param becomes_place  whether the newest key frame is itself made a place
  /// @return false when the rest of the map contradicts it; it is then forgotten
  bool recognise(const Tie& seen, bool becomes_place);

  /// Where a key frame stands: at the place of its tie, by odometry since.
  Tie standing(int key_frame) const;
  Pose T_map_left(int key_frame) const;
  /// What the map knows of one key frame's pose in another; none when no edges join them. The covariance is
  /// that of the chain of edges that leaves least: an upper bound.
  std::optional<RelativeMotion> relative(int from_key_frame, int to_key_frame);

  /// Pose of every place.
  const std::vector<Pose>& T_map_place() const { return T_map_place_; }
  int places() const { return static_cast<int>(T_map_place_.size()); }
  /// Number of the last tie, which the newest key frame hangs on.
  int tie() const { return static_cast<int>(ties_.size()) - 1; }
  /// By tie, oldest first.
  std::vector<Pose> T_map_odom() const;

 private:
  /// Two ties, joined by odometry from the key frame of the one to that of the other.
  struct Edge {
    Tie from, to;
    bool recognised = false;
  };
  /// Uncertainty of one key frame in every place.
  struct Spread {
    int key_frame = -1;
    std::vector<Matrix6d> covariance;  ///< of T_place_left, right perturbation
  };

  RelativeMotion odometry(int from_key_frame, int to_key_frame) const;
  RelativeMotion motion(const Edge& edge) const;
  void hang_on(const Tie& tie);
  void add_edge(const Edge& edge);
  void follow_odometry();
  bool join(const Edge& edge);
  void move_component(const Edge& edge, std::vector<Pose>& T_map_place) const;
  bool solve(const Edge& newest, std::vector<Pose>& T_map_place) const;
  void spread_from(int key_frame);

  std::vector<OdometryPose> path_;  ///< by key frame
  std::vector<int> tie_of_;         ///< by key frame
  std::vector<Pose> T_map_place_;
  std::vector<int> key_frame_of_place_;
  std::vector<int> component_;  ///< by place: lowest place that it is joined to
  std::vector<Edge> edges_;
  std::vector<Tie> ties_;
  Spread spread_;  ///< of the key frame last asked for; forgotten when anything changes
};

}  // namespace groundloop::slam
