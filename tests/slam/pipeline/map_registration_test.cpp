#include "slam/pipeline/map_registration.h"

#include <gtest/gtest.h>

#include "slam/adjustment/relative_pose.h"
#include "tests/slam/mapping/room_world.h"

namespace groundloop::slam {
namespace {

constexpr int kLap = 48;
constexpr double kSigma_m = 0.03, kSigma_rad = 0.004;

Matrix6d step_covariance() {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(kSigma_m * kSigma_m),
      Eigen::Vector3d::Constant(kSigma_rad * kSigma_rad);
  return variance.asDiagonal();
}

MapMatchOptions options() {
  MapMatchOptions options;
  options.key_frames = 12;
  options.min_age_frames = 24;
  return options;
}

struct Found {
  int key_frame;
  MapSight sight;
};

/// A lap and a quarter through the laboratory, with what odometry gathers: every key frame a place.
class Drive {
 public:
  /// @param drift  of one step's motion
  explicit Drive(const Vector6d& drift, const MapMatchOptions& match_options = options(),
                 const Matrix6d& covariance = step_covariance())
      : covariance_(covariance),
        registration_(laboratory_rig(), {}, match_options, 8),
        drift_(se3_exp(drift)) {}

  /// @return what the maps said on the way, which is not heeded
  std::vector<Found> go(int key_frames) {
    std::vector<Found> found;
    for (int k = 0; k < key_frames; ++k) {
      step(k);
      if (auto sight = registration_.match(places_)) found.push_back({k, *sight});
    }
    return found;
  }

  Pose truth(int k) const { return lap_[k % kLap]; }
  Pose estimate(int k) const { return places_.T_map_left(k); }
  /// What is wrong with a pose of `to` in `from`, in the body's axes.
  Vector6d error(int from, int to, const Pose& T_from_to) const {
    const Pose T_body_left = laboratory_rig().T_body_left;
    const Pose wrong = (truth(from).inverse() * truth(to)).inverse() * T_from_to;
    return se3_log(T_body_left * wrong * T_body_left.inverse());
  }

 private:
  void step(int k) {
    if (k > 0) T_odom_left_ = T_odom_left_ * truth(k - 1).inverse() * truth(k) * drift_;
    places_.advance({k, T_odom_left_, covariance_}, {});
    if (k == 0) {
      places_.start(T_odom_left_);
    } else {
      places_.add_place();
    }
    const Tie tie = places_.standing(k);
    std::vector<MapObservation> observations;
    for (const MapPoint& point : measure(world_, laboratory_rig(), truth(k), 500, 0.1, k)) {
      const Eigen::Vector3d uvu = laboratory_rig().project(truth(k).inverse() * point.p_map);
      observations.push_back({uvu.cast<float>(), 1});
    }
    const Look look{k,
                    tie.place,
                    tie.T_place_left,
                    std::make_shared<const std::vector<MapObservation>>(observations),
                    {}};
    registration_.add(look, k, k == 0);
  }

  Matrix6d covariance_;
  RoomWorld world_ = RoomWorld::laboratory();
  std::vector<Pose> lap_ = laboratory_lap(kLap);
  MapRegistration registration_;
  Pose drift_;
  PlaceMap places_;
  Pose T_odom_left_ = lap_[0];
};

Vector6d drift(double x_m, double y_m, double z_m, double turn_rad) {
  Vector6d twist;
  twist << x_m, y_m, z_m, 0, turn_rad, 0;  // in the camera: y points down, turns to the side are about it
  return twist;
}

const Vector6d kDrift = drift(0.001, 0.002, 0.004, 0.0006);

TEST(MapRegistration, FindsTheErrorThatALapHasGathered) {
  Drive drive(kDrift);
  const std::vector<Found> found = drive.go(kLap + 14);
  ASSERT_FALSE(found.empty());
  for (const auto& [key_frame, sight] : found) {
    const Pose believed = drive.estimate(sight.from_key_frame).inverse() * drive.estimate(key_frame);
    const Vector6d before = drive.error(sight.from_key_frame, key_frame, believed);
    const Vector6d after = drive.error(sight.from_key_frame, key_frame, sight.T_from_to);
    EXPECT_GT(before.head<3>().norm(), 0.1) << "hardly an error to find at " << key_frame;
    EXPECT_LT(after.head<3>().norm(), 0.05) << key_frame;
    EXPECT_LT(after.tail<3>().norm(), 0.01) << key_frame;
    const Matrix6d to_body = se3_adjoint(laboratory_rig().T_body_left);
    const Matrix6d covariance = to_body * sight.covariance * to_body.transpose();
    EXPECT_LT(after.dot(covariance.ldlt().solve(after)), 40) << key_frame;
    EXPECT_LT(sight.from_key_frame, key_frame - options().min_age_frames);
    EXPECT_GT(sight.cells, options().min_cells / 2);
  }
}

TEST(MapRegistration, SaysNothingWhereNothingOldIsNear) { EXPECT_TRUE(Drive(kDrift).go(kLap - 6).empty()); }

TEST(MapRegistration, SaysNothingOfAPoseThatIsKnownWell) {
  MapMatchOptions contented = options();
  contented.min_prior_sigma_m = 5;
  EXPECT_TRUE(Drive(kDrift, contented).go(kLap + 14).empty());
}

TEST(MapRegistration, SaysNothingOfWhatFlies) {
  // Odometry is sure of the height and says that it has changed: no common floor.
  Matrix6d sure_of_height = step_covariance();
  for (const int i : {1, 3, 5}) sure_of_height(i, i) = 1e-10;  // the camera's y axis points down
  EXPECT_TRUE(Drive(drift(0, 0.004, 0.002, 0), options(), sure_of_height).go(kLap + 14).empty());
  EXPECT_FALSE(Drive(drift(0, 0.004, 0.002, 0)).go(kLap + 14).empty());
}

TEST(MapRegistration, WaitsForALocalMapOfEnoughLooks) {
  MapMatchOptions larger = options();
  larger.key_frames = kLap + 20;
  EXPECT_TRUE(Drive(kDrift, larger).go(kLap + 14).empty()) << "too few looks for a local map";
}

}  // namespace
}  // namespace groundloop::slam
