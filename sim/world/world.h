#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "sim/world/mjcf.h"

namespace groundloop::sim {

/// MJCF text of the scenario's world when it is generated, else none.
/// @pre the recipe has a seed
std::optional<std::string> generated_text(const Scenario& scenario);

/// The scenario's world: what its file holds, or what its recipe gives.
MjcfElement world_mjcf(const Scenario& scenario);

/// What a scenario's models are loaded for.
enum class Looks {
  kAll,
  kNone,  ///< no textures: the same geometry, loaded many times faster
};

/// The scenario's world, robot and people in one MJCF document, in the order in which MuJoCo numbers them.
struct ComposedScene {
  MjcfElement mjcf;
  std::string robot_body;  ///< name of the robot's root body
};
/// @throws InputError naming file, line and element: unreadable XML, missing files, no robot body
ComposedScene compose_scene(const Scenario& scenario, Looks looks = Looks::kAll);

/// A world file and a robot file composed into one MuJoCo model, at the scenario's scale. Constant after
/// loading.
/// The robot's root body is the body of the robot file that has a free joint; its frame is `body`
/// (x forward, y left, z up, origin on the floor below the axle). An arm's root body is its base, which
/// stands.
class World {
 public:
  /// @throws InputError naming file, line and element (a missing texture, XML that MuJoCo rejects, no robot
  /// body)
  static World load(const Scenario& scenario, Looks looks = Looks::kAll);
  /// A world without a robot, for tests and previews.
  static World load_file(const std::string& world_file);

  const mjModel& model() const { return *model_; }
  int robot_body() const { return robot_body_; }  ///< MuJoCo body id; -1 without a robot
  bool is_robot_geom(int geom) const;             ///< part of the robot's body tree
  bool is_person_geom(int geom) const;            ///< part of someone who walks about

  using ModelPtr = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
  using DataPtr = std::unique_ptr<mjData, decltype(&mj_deleteData)>;
  /// Fresh state: robot at the scenario's start pose, everything else as in the file.
  DataPtr make_data() const;

 private:
  World(ModelPtr model, int robot_body, std::vector<int> people, const StartPose& start);
  void put_down_base();
  ModelPtr model_;
  int robot_body_;
  std::vector<int> people_;  ///< root bodies
  StartPose start_;
};

}  // namespace groundloop::sim
