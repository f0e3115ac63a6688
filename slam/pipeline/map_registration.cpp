#include "slam/pipeline/map_registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "slam/adjustment/relative_pose.h"
#include "slam/mapping/mapper.h"

namespace groundloop::slam {
namespace {

constexpr std::array<int, 3> kPlanar = {0, 1, 5};  // x, y and yaw of a perturbation (translation, rotation)

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

Pose spatial(const Eigen::Isometry2d& flat) {
  Pose T = Pose::Identity();
  T.linear().topLeftCorner<2, 2>() = flat.linear();
  T.translation().head<2>() = flat.translation();
  return T;
}

Eigen::Matrix3d planar_part(const Matrix6d& covariance) {
  Eigen::Matrix3d part;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) part(i, j) = covariance(kPlanar[i], kPlanar[j]);
  return part;
}

/// What the match says of the plane, and what was known before of the rest.
Matrix6d with_planar_part(const Matrix6d& known, const Eigen::Matrix3d& matched) {
  Matrix6d covariance = known;
  for (const int i : kPlanar) covariance.row(i).setZero(), covariance.col(i).setZero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) covariance(kPlanar[i], kPlanar[j]) = matched(i, j);
  return covariance;
}

double worst_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
  return std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
}

}  // namespace

MapRegistration::MapRegistration(const StereoRig& rig, const FlogOptions& mapping,
                                 const MapMatchOptions& options, int looks_kept)
    : rig_(rig),
      mapping_(mapping),
      options_(options),
      global_(rig, mapping, looks_kept),
      until_next_(options.key_frames) {}

void MapRegistration::add(Look look, int64_t frame, bool starts_segment,
                          const std::vector<Pose>& T_map_place) {
  in_segment_ = starts_segment ? 1 : in_segment_ + 1;
  if (starts_segment) until_next_ = options_.key_frames;
  --until_next_;
  held_.push_back({std::move(look), frame});
  while (held_.front().frame <= frame - options_.min_age_frames) {
    global_.add(std::move(held_.front().look), T_map_place);
    held_.pop_front();
  }
}

std::optional<MapSight> MapRegistration::match(PlaceMap& places) {
  const std::vector<Pose>& T_map_place = places.T_map_place();
  const Look& newest = held_.back().look;
  const Pose T_map_left = T_map_place[newest.place] * newest.T_place_left;
  const Look* old = until_next_ > 0 ? nullptr : nearest_old_look(T_map_left, T_map_place);
  if (old == nullptr) return std::nullopt;
  const std::optional<RelativeMotion> known = places.relative(old->key_frame, newest.key_frame);
  if (!known) return std::nullopt;
  const Pose T_map_level = level_under(T_map_left * rig_.T_body_left.inverse());
  const Pose T_level_left = T_map_level.inverse() * T_map_left;
  const Matrix6d to_level = se3_adjoint(T_level_left);
  const Matrix6d known_level = to_level * known->covariance * to_level.transpose();
  const PlanarPose prior{planar(T_map_level), planar_part(known_level)};
  if (worst_sigma_m(prior.covariance) < options_.min_prior_sigma_m) return std::nullopt;

  until_next_ = std::max(1, options_.key_frames / 3);
  const OccupancyMap local = local_map(T_map_level, T_map_place);
  const MapMatch match = match_maps(global_.grid().map(), local, prior, options_);
  if (!match.accepted) return std::nullopt;
  const Pose T_map_matched =
      spatial(match.pose.T_global_local * prior.T_global_local.inverse()) * T_map_left;
  const Pose T_map_old = T_map_place[old->place] * old->T_place_left;
  const Matrix6d from_level = se3_adjoint(T_level_left.inverse());
  const Matrix6d matched = with_planar_part(known_level, match.pose.covariance);
  return MapSight{old->key_frame, renormalised(T_map_old.inverse() * T_map_matched),
                  from_level * matched * from_level.transpose(),
                  static_cast<int>(match.overlap * match.agreement * match.cells)};
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
OccupancyMap MapRegistration::local_map(const Pose& T_map_local,
                                        const std::vector<Pose>& T_map_place) const {
  Mapper mapper(rig_, mapping_);
  const auto looks = std::min<size_t>({held_.size(), static_cast<size_t>(in_segment_),
                                       static_cast<size_t>(options_.key_frames)});
  for (size_t i = held_.size() - looks; i < held_.size(); ++i) {
    const Look& look = held_[i].look;
    mapper.add(T_map_local.inverse() * T_map_place[look.place] * look.T_place_left, look.observations);
  }
  return mapper.grid().map();
}

}  // namespace groundloop::slam
