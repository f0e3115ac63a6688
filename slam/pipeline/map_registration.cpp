#include "slam/pipeline/map_registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "slam/adjustment/relative_pose.h"
#include "slam/mapping/mapper.h"

namespace groundloop::slam {
namespace {

// Of a perturbation (translation, rotation): x, y, yaw; and z, roll, pitch.
constexpr std::array<int, 3> kPlanar = {0, 1, 5}, kUpright = {2, 3, 4};
constexpr double kDegree = std::numbers::pi / 180;

/// The frame under the body: level, at the map's height 0, heading as the body does.
Pose level_under(const Pose& T_map_body) {
  const Eigen::Matrix3d& R = T_map_body.linear();
  Pose T_map_level = Pose::Identity();
  T_map_level.linear() =
      Eigen::AngleAxisd(std::atan2(R(1, 0), R(0, 0)), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_map_level.translation().head<2>() = T_map_body.translation().head<2>();
  return T_map_level;
}

Eigen::Isometry2d planar(const Pose& T) {
  Eigen::Isometry2d flat = Eigen::Isometry2d::Identity();
  flat.linear() = T.linear().topLeftCorner<2, 2>();
  flat.translation() = T.translation().head<2>();
  return flat;
}

/// The body at a place of the plane, standing on the floor as it did at another place: as high, its up axis
/// the same.
Pose standing_as(const Pose& T_map_body, const Eigen::Isometry2d& T_map_flat) {
  const Eigen::Vector3d up_map = T_map_body.linear().col(2);
  Pose T = Pose::Identity();
  T.linear().topLeftCorner<2, 2>() = T_map_flat.linear();
  T.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up_map) * T.linear();
  T.translation() << T_map_flat.translation(), T_map_body.translation().z();
  return T;
}

Eigen::Matrix3d part(const Matrix6d& covariance, const std::array<int, 3>& which) {
  Eigen::Matrix3d part;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) part(i, j) = covariance(which[i], which[j]);
  return part;
}

double worst_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
  return std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
}

/// The same covariance of the body in place of the left camera.
Matrix6d body_covariance(const StereoRig& rig, const RelativeMotion& known) {
  const Matrix6d to_body = se3_adjoint(rig.T_body_left);
  return to_body * known.covariance * to_body.transpose();
}

}  // namespace

MapRegistration::MapRegistration(const StereoRig& rig, const FlogOptions& mapping,
                                 const MapMatchOptions& options, int looks_kept)
    : rig_(rig),
      mapping_(mapping),
      options_(options),
      global_(rig, mapping, looks_kept),
      until_next_(options.key_frames) {}

void MapRegistration::add(Look look, int64_t frame, bool starts_segment) {
  in_segment_ = starts_segment ? 1 : in_segment_ + 1;
  if (starts_segment) until_next_ = options_.key_frames;
  --until_next_;
  held_.push_back({std::move(look), frame});
  while (held_.front().frame <= frame - options_.min_age_frames) {
    global_.keep(std::move(held_.front().look));
    held_.pop_front();
  }
}

std::optional<MapSight> MapRegistration::match(PlaceMap& places) {
  constexpr size_t kLooksACall = 4;
  constexpr double kSoon = 0.75;  // uncertainty, of that from which a match is wanted: time to draw the map
  if (global_.looks().empty()) return std::nullopt;
  const std::vector<Pose>& T_map_place = places.T_map_place();
  const Look& newest = held_.back().look;
  const auto since_first = places.relative(global_.looks().front().key_frame, newest.key_frame);
  if (!since_first || planar_sigma_m(*since_first) < kSoon * options_.min_prior_sigma_m) return std::nullopt;
  const bool drawn = global_.draw(T_map_place, kLooksACall);
  const Pose T_map_left = T_map_place[newest.place] * newest.T_place_left;
  const Look* old = until_next_ > 0 || !drawn ? nullptr : nearest_old_look(T_map_left, T_map_place);
  if (old == nullptr) return std::nullopt;
  const std::optional<RelativeMotion> known = places.relative(old->key_frame, newest.key_frame);
  if (!known) return std::nullopt;
  const Matrix6d known_body = body_covariance(rig_, *known);
  const Pose T_map_body = T_map_left * rig_.T_body_left.inverse();
  const Pose T_map_level = level_under(T_map_body);
  const PlanarPose prior{planar(T_map_level), part(known_body, kPlanar)};
  if (worst_sigma_m(prior.covariance) < options_.min_prior_sigma_m) return std::nullopt;

  until_next_ = std::max(1, options_.key_frames / 3);
  const MapMatch match =
      match_maps(global_.grid().map(), local_map(T_map_level, T_map_place), prior, options_);
  if (!match.accepted) return std::nullopt;
  const Pose T_map_old = T_map_place[old->place] * old->T_place_left;
  const Pose T_map_matched = standing_as(T_map_old * rig_.T_body_left.inverse(), match.pose.T_global_local);
  if (!on_one_floor(T_map_body.inverse() * T_map_matched, known_body)) return std::nullopt;
  const Matrix6d from_body = se3_adjoint(rig_.T_body_left.inverse());
  return MapSight{old->key_frame, renormalised(T_map_old.inverse() * T_map_matched * rig_.T_body_left),
                  from_body * covariance_of(match) * from_body.transpose(),
                  static_cast<int>(match.overlap * match.agreement * match.cells)};
}

/// Of the body's place on the floor, in the worst direction.
double MapRegistration::planar_sigma_m(const RelativeMotion& known) const {
  return worst_sigma_m(part(body_covariance(rig_, known), kPlanar));
}

/// Whether what was known of height and tilt allows the correction: a drone, or a ramp, is on no common
/// floor.
bool MapRegistration::on_one_floor(const Pose& T_body_matched, const Matrix6d& known_body) const {
  constexpr double kLeastLikely = 16.3;  // chi square of three degrees of freedom, one in a thousand
  const Vector6d change = se3_log(T_body_matched);
  const Eigen::Vector3d upright(change[kUpright[0]], change[kUpright[1]], change[kUpright[2]]);
  const Eigen::Matrix3d C = part(known_body, kUpright) + Eigen::Matrix3d(upright_variance().asDiagonal());
  return upright.dot(C.ldlt().solve(upright)) < kLeastLikely;
}

Eigen::Vector3d MapRegistration::upright_variance() const {
  const double sigma_rad = options_.level_sigma_deg * kDegree;
  return Eigen::Vector3d(options_.level_sigma_m, sigma_rad, sigma_rad).cwiseAbs2();
}

/// Of the body: in the plane by the match, out of it by the floor.
Matrix6d MapRegistration::covariance_of(const MapMatch& match) const {
  const Eigen::Vector3d upright = upright_variance();
  Matrix6d covariance = Matrix6d::Zero();
  for (int i = 0; i < 3; ++i) {
    covariance(kUpright[i], kUpright[i]) = upright[i];
    for (int j = 0; j < 3; ++j) covariance(kPlanar[i], kPlanar[j]) = match.pose.covariance(i, j);
  }
  return covariance;
}

/// The look of the global map that stands nearest.
const Look* MapRegistration::nearest_old_look(const Pose& T_map_left,
                                              const std::vector<Pose>& T_map_place) const {
  constexpr double kReach_m = 2;  // farther away other walls are seen, or the map between may be bent
  const Look* nearest = nullptr;
  double least_m = kReach_m;
  for (const Look& look : global_.looks()) {
    const Pose T_map_old = T_map_place[look.place] * look.T_place_left;
    const double distance_m = (T_map_old.translation() - T_map_left.translation()).head<2>().norm();
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = &look;
  }
  return nearest;
}

/// The newest looks of this segment, in a frame of their own: combined views that may look around.
OccupancyMap MapRegistration::local_map(const Pose& T_map_local, const std::vector<Pose>& T_map_place) const {
  Mapper mapper(rig_, mapping_);
  const auto looks = std::min<size_t>(
      {held_.size(), static_cast<size_t>(in_segment_), static_cast<size_t>(options_.key_frames)});
  for (size_t i = held_.size() - looks; i < held_.size(); ++i) {
    const Look& look = held_[i].look;
    mapper.add(T_map_local.inverse() * T_map_place[look.place] * look.T_place_left, *look.observations);
  }
  return mapper.grid().map();
}

}  // namespace groundloop::slam
