#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sim/head/head.h"
#include "sim/scenario/scenario.h"
#include "sim/world/lighting.h"
#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// Exposures that pass before a pose of the core acts on the wheels.
inline constexpr int64_t kFeedbackPairs = 1;

/// The scene at one moment of an image's exposure, for the camera that takes it.
struct SubFrame {
  std::shared_ptr<const mjData> state;
  LightFactors lights;
  slam::Pose T_world_camera;
};

/// The state of the world at one exposure, with its truth.
struct Exposure {
  int64_t index = 0;
  int64_t stamp_ns = 0;
  slam::Pose T_world_body;     ///< true pose of the robot's body frame
  slam::Pose T_world_left;     ///< true pose of the left camera
  slam::Pose T_world_right;    ///< as it is: later or earlier by a trigger offset, turned by a knock
  slam::Pose T_odom_body;      ///< wheel odometry (with its errors) since the start, planar
  slam::Pose T_plan_body;      ///< where the plan says the robot is, world frame (after a kidnapping: goes on
                               ///< from where it was put)
  slam::Pose T_previous_left;  ///< motion since the last exposure as planned, or as odometry says when it
                               ///< steers (what the core may know); identity at the first
  std::shared_ptr<const mjData> state;  ///< MuJoCo state to render; may be kept, and freed in any thread
  LightFactors lights;                  ///< how bright the lamps are
  std::shared_ptr<const mjData> state_right;  ///< the same for the right camera; another one only when it
                                              ///< exposes at another time
  /// For a head that takes time for an image: the scene at each of HeadModel::sub_frame_times_s(). Empty when
  /// there is nothing but the moment of the stamp, or nothing moves.
  std::vector<SubFrame> left_sub_frames, right_sub_frames;
};

/// Pose of the left camera in the map (slam::FrameResult::T_map_left) that the core found for the images of
/// an exposure; waits until it is known. None when there is none: lost, or the pair did not arrive.
using PoseFeedback = std::function<std::optional<slam::Pose>(int64_t exposure)>;

/// What carries the head from exposure to exposure: a robot on wheels, or an arm. Members as in Simulation.
class HeadCarrier {
 public:
  virtual ~HeadCarrier() = default;
  virtual std::optional<Exposure> advance() = 0;
  virtual int64_t exposure_count() const = 0;
  virtual double planned_length_m() const = 0;
  virtual slam::Pose planned_T_world_body(double time_s) const = 0;
  virtual double planned_duration_s() const = 0;
};

/// Physics, controller and odometry: drives the plan and stops at every exposure. What follows is said of a
/// robot on wheels; an arm has a plan of its own kind (ArmSimulation).
///
/// Time: exposure k is at k times the head's period exactly. Physics runs in the model's own steps whatever
/// the head's rate, so the drive is the same for every head; an exposure between two steps continues the last
/// step's velocities for the remainder, in a copy of the state. That copy is both what is rendered and what
/// is true. The moments of an exposure that takes time are such continuations, too, before and after the
/// stamp: for some milliseconds the velocities stay.
///
/// `feedback: slam`: on the way from exposure k - 1 to k the robot steers by the core's pose of exposure
/// k - 1 - kFeedbackPairs and by what its odometry counted since, however fast or slow the core is. The map
/// is laid on the plan by the first pose.
///
/// Faults of the scenario that change what happens (slip, kidnapping, encoders, knocks, trigger) act here;
/// those of images and their transport do not (sim/faults).
///
/// The first exposure is at time 0, after the robot has settled on its wheels. The drive takes as long as the
/// plan; exposures() = floor(duration / period) + 1.
class Simulation {
 public:
  /// @throws InputError when the plan runs into something (names segment, place and geom) or the models do
  /// not fit
  /// @param core_pose  needed to advance() under `feedback: slam`
  Simulation(const World& world, const HeadModel& head, const Scenario& scenario,
             PoseFeedback core_pose = {});
  ~Simulation();

  /// Advances to the next exposure; none when the plan is driven.
  std::optional<Exposure> advance();
  /// Exposures of the whole plan.
  int64_t exposures() const;
  /// Length of the planned path [m].
  double planned_length_m() const;
  /// Where the plan puts the robot's body frame at a time from 0 to planned_duration_s().
  slam::Pose planned_T_world_body(double time_s) const;
  /// Time the plan takes [s].
  double planned_duration_s() const;

 private:
  struct Wheeled;
  std::unique_ptr<HeadCarrier> carrier_;
};

}  // namespace groundloop::sim
