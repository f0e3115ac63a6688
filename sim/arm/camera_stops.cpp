#include "sim/arm/camera_stops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/robot/pose2.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Pieces of a path with the number of steps that each needs.
class PathWalker {
 public:
  PathWalker(const CameraPath& path, const Pose2& start) : path_(path), at_(start) {
    places_.push_back(start);
  }

  /// Forwards, on a circle when it turns, or sideways.
  void go(double forward_m, double left_m, double turn_rad) {
    const double length_m = std::hypot(forward_m, left_m);
    const auto steps = static_cast<int>(
        std::ceil(std::max(length_m / path_.step_m, std::abs(turn_rad) / (path_.step_deg * kDegree)) - 1e-9));
    const Pose2 start = at_;
    for (int step = 1; step <= steps; ++step) {
      const double part = static_cast<double>(step) / steps;
      at_ = left_m != 0 ? composed(start, {part * forward_m, part * left_m, 0})
                        : driven(start, part * forward_m, part * turn_rad);
      places_.push_back(at_);
    }
  }
  const std::vector<Pose2>& places() const { return places_; }

 private:
  const CameraPath& path_;
  Pose2 at_;
  std::vector<Pose2> places_;
};

std::vector<Pose2> places_of_drive(const CameraPath& path, const DrivePath& drive) {
  PathWalker walker(path, {drive.x_m, drive.y_m, drive.yaw_deg * kDegree});
  for (const PathPiece& piece : drive.pieces) {
    if (piece.straight_m) walker.go(*piece.straight_m, 0, 0);
    if (piece.sideways_m) walker.go(0, *piece.sideways_m, 0);
    if (!piece.arc) continue;
    const double turn_rad = piece.arc->angle_deg * kDegree;
    walker.go(piece.arc->radius_m * std::abs(turn_rad), 0, turn_rad);
  }
  std::vector<Pose2> places = walker.places();
  for (Pose2& place : places) place.yaw_rad += drive.look_deg * kDegree;
  return places;
}

std::vector<Pose2> places_of_raster(const CameraPath& path, const RasterPath& raster) {
  const Pose2 middle{raster.x_m, raster.y_m, raster.yaw_deg * kDegree};
  PathWalker walker(path, composed(middle, {0, raster.width_m / 2, 0}));
  const double between_m = raster.rows > 1 ? raster.depth_m / (raster.rows - 1) : 0;
  for (int row = 0; row < raster.rows; ++row) {
    if (row > 0 && between_m > 0) walker.go(between_m, 0, 0);
    walker.go(0, row % 2 == 0 ? -raster.width_m : raster.width_m, 0);
  }
  return walker.places();
}

std::vector<CameraStop> stops_of_path(const CameraPath& path, double scale) {
  const std::vector<Pose2> places =
      path.drive ? places_of_drive(path, *path.drive) : places_of_raster(path, *path.raster);
  std::vector<CameraStop> stops;
  for (const Pose2& place : places) {
    const auto number = static_cast<int64_t>(stops.size());
    const Eigen::Vector3d p_world = scale * Eigen::Vector3d(place.x_m, place.y_m, path.z_m);
    stops.push_back({level_look(p_world, place.yaw_rad, path.tilt_deg * kDegree), number,
                     fmt::format("plan.path (stop {})", number), path.line});
  }
  return stops;
}

/// Number of the pair that a pose is to be reached by; the problem when there is none.
int64_t pair_of(const Scenario& scenario, size_t index, int64_t next, int64_t period_ns,
                std::vector<Problem>& problems) {
  const CameraPose& pose = scenario.plan.poses[index];
  if (!pose.at_s) return next;
  const double period_s = static_cast<double>(period_ns) * 1e-9;
  const double pairs = *pose.at_s / period_s;
  const auto pair = std::llround(pairs);
  const bool first_late = index == 0 && pair != 0;
  if (std::abs(pairs - static_cast<double>(pair)) > 1e-6 || pair < next || first_late) {
    problems.push_back({scenario.file, pose.line, fmt::format("plan.poses[{}].at_s", index),
                        fmt::format("{}", *pose.at_s),
                        first_late ? "0 for the first pose"
                                   : fmt::format("a multiple of {} s, the time between pairs, of at least {}",
                                                 period_s, static_cast<double>(next) * period_s)});
  }
  return std::max<int64_t>(pair, next);
}

std::vector<CameraStop> stops_of_poses(const Scenario& scenario, int64_t period_ns) {
  std::vector<CameraStop> stops;
  std::vector<Problem> problems;
  int64_t next = 0;
  for (size_t i = 0; i < scenario.plan.poses.size(); ++i) {
    const CameraPose& pose = scenario.plan.poses[i];
    const Eigen::Vector3d p_world = scenario.scale * Eigen::Vector3d(pose.x_m, pose.y_m, pose.z_m);
    const int64_t pair = pair_of(scenario, i, next, period_ns, problems);
    next = pair + 1;
    stops.push_back({level_look(p_world, pose.yaw_deg * kDegree, pose.tilt_deg * kDegree), pair,
                     fmt::format("plan.poses[{}]", i), pose.line});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return stops;
}

}  // namespace

slam::Pose level_look(const Eigen::Vector3d& p_world, double yaw_rad, double tilt_rad) {
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ()), up(-tilt_rad, Eigen::Vector3d::UnitY());
  slam::Pose T_world_left = slam::Pose::Identity();
  T_world_left.linear() = (yaw * up).toRotationMatrix() * slam::StereoRig::level_camera({0, 0, 0}).linear();
  T_world_left.translation() = p_world;
  return T_world_left;
}

std::vector<CameraStop> camera_stops(const Scenario& scenario, int64_t period_ns) {
  return scenario.plan.path ? stops_of_path(*scenario.plan.path, scenario.scale)
                            : stops_of_poses(scenario, period_ns);
}

}  // namespace groundloop::sim
