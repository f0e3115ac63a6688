#include "sim/world/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <numbers>
#include <regex>
#include <stdexcept>

#include "sim/world/compose.h"
#include "sim/world/generate/generate.h"
#include "sim/world/mjcf.h"
#include "sim/world/people.h"
#include "sim/world/scale.h"

namespace groundloop::sim {
namespace {

constexpr double kNear_m = 0.04;
constexpr double kFar_m = 60;

/// MuJoCo's own handlers print, write MUJOCO_LOG.TXT and call exit().
void install_handlers() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = [](const char* message) { throw std::runtime_error(std::string("MuJoCo: ") + message); };
    mju_user_warning = [](const char* message) { fmt::print(stderr, "MuJoCo warning: {}\n", message); };
  });
}

/// MuJoCo's message with the user's file and line in place of the composed document's.
InputError load_error(std::string message, const MjcfText& document) {
  static const std::regex line_pattern("line (= )?([0-9]+)");
  const MjcfElement* element = document.element_of_line.front();
  std::smatch match;
  if (std::regex_search(message, match, line_pattern)) {
    const size_t line = std::stoul(match[2]);
    if (line >= 1 && line <= document.element_of_line.size()) element = document.element_of_line[line - 1];
    message = message.substr(0, message.find_last_of('\n', static_cast<size_t>(match.position())));
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  return InputError(element->problem(message, "MJCF that MuJoCo accepts"));
}

World::ModelPtr compile(const MjcfElement& scene) {
  // mj_loadXML has global state (it calls srand(), too).
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  install_handlers();

  const MjcfText document = write_mjcf(scene);
  constexpr const char* kName = "scene.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const std::unique_ptr<mjVFS, decltype(&mj_deleteVFS)> cleanup(files.get(), mj_deleteVFS);
  mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(document.text.size()));
  std::memcpy(files->filedata[0], document.text.data(), document.text.size());

  std::array<char, 1000> error{};
  World::ModelPtr model(mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size())),
                        mj_deleteModel);
  if (!model) throw load_error(error.data(), document);
  if (error[0] != '\0') fmt::print(stderr, "MuJoCo warning: {}: {}\n", scene.file, error.data());
  return model;
}

/// A wall must look the same from everywhere: the head-light keeps only its ambient part. Clipping planes are
/// set in metres; MuJoCo stores them in units of the scene's extent.
void prepare_for_cameras(mjModel& model) {
  std::fill_n(model.vis.headlight.diffuse, 3, 0.0F);
  std::fill_n(model.vis.headlight.specular, 3, 0.0F);
  model.stat.extent = std::max(model.stat.extent, 0.1);
  model.vis.map.znear = static_cast<float>(kNear_m / model.stat.extent);
  model.vis.map.zfar = static_cast<float>(std::max(kFar_m / model.stat.extent, 3.0));
}

void strip_textures(MjcfElement& root) {
  for (MjcfElement& section : root.children) {
    if (section.tag != "asset") continue;
    std::erase_if(section.children, [](const MjcfElement& asset) { return asset.tag == "texture"; });
  }
  MjcfElement::walk(root, [](MjcfElement& element) {
    if (element.tag == "material") element.erase("texture");
  });
}

}  // namespace

World::World(ModelPtr model, int robot_body, std::vector<int> people, const StartPose& start)
    : model_(std::move(model)), robot_body_(robot_body), people_(std::move(people)), start_(start) {
  prepare_for_cameras(*model_);
  put_down_base();
}

/// A base stands where the scenario starts: in the model itself, since no joint moves it.
void World::put_down_base() {
  if (robot_body_ < 0 || model_->body_jntnum[robot_body_] > 0) return;
  mjtNum* pos = model_->body_pos + 3 * robot_body_;
  mjtNum* quat = model_->body_quat + 4 * robot_body_;
  const double half_yaw_rad = start_.yaw_deg * std::numbers::pi / 360;
  const mjtNum yaw[4] = {std::cos(half_yaw_rad), 0, 0, std::sin(half_yaw_rad)};
  const mjtNum there[3] = {start_.x_m, start_.y_m, 0};
  const mjtNum pos_file[3] = {pos[0], pos[1], pos[2]};
  const mjtNum quat_file[4] = {quat[0], quat[1], quat[2], quat[3]};
  mju_mulPose(pos, quat, there, yaw, pos_file, quat_file);
}

std::optional<std::string> generated_text(const Scenario& scenario) {
  if (!scenario.world.generate) return std::nullopt;
  return generated_world(*scenario.world.generate);
}

MjcfElement world_mjcf(const Scenario& scenario) {
  const auto text = generated_text(scenario);
  return text ? read_mjcf_text(*text, scenario.file + " (generated world)") : read_mjcf(scenario.world.file);
}

ComposedScene compose_scene(const Scenario& scenario, Looks looks) {
  MjcfElement world = world_mjcf(scenario);
  MjcfElement robot = read_mjcf(scenario.robot.model);
  std::vector<MjcfElement> people;
  for (const Person& person : scenario.people) people.push_back(read_person(person.model, person.name));
  if (looks == Looks::kNone) {
    strip_textures(world);
    strip_textures(robot);
    for (MjcfElement& person : people) strip_textures(person);
  }
  std::string robot_body = robot_root_body(robot);  // before it moves away: a root without a name gets one
  return {compose_mjcf(std::move(world), std::move(robot), std::move(people)), std::move(robot_body)};
}

World World::load(const Scenario& scenario, Looks looks) {
  const ComposedScene scene = compose_scene(scenario, looks);
  ModelPtr model = compile(scene.mjcf);
  const auto body_id = [&](const std::string& name) {
    return mj_name2id(model.get(), mjOBJ_BODY, name.c_str());
  };
  const int robot_body = body_id(scene.robot_body);
  std::vector<int> people_bodies;
  for (const Person& person : scenario.people) people_bodies.push_back(body_id(person.name));
  StartPose start = scenario.robot.start;
  if (scenario.scale != 1) {
    scale_model(*model, scenario.scale);
    start.x_m *= scenario.scale;
    start.y_m *= scenario.scale;
  }
  return World(std::move(model), robot_body, std::move(people_bodies), start);
}

World World::load_file(const std::string& world_file) {
  return World(compile(read_mjcf(world_file)), -1, {}, {});
}

bool World::is_robot_geom(int geom) const {
  return robot_body_ >= 0 && model_->body_rootid[model_->geom_bodyid[geom]] == robot_body_;
}

bool World::is_person_geom(int geom) const {
  const int root = model_->body_rootid[model_->geom_bodyid[geom]];
  return std::find(people_.begin(), people_.end(), root) != people_.end();
}

World::DataPtr World::make_data() const {
  DataPtr data(mj_makeData(model_.get()), mj_deleteData);
  if (robot_body_ >= 0 && model_->body_jntnum[robot_body_] > 0) {
    mjtNum* q = data->qpos + model_->jnt_qposadr[model_->body_jntadr[robot_body_]];
    q[0] = start_.x_m;
    q[1] = start_.y_m;
    const double half_yaw_rad = start_.yaw_deg * std::numbers::pi / 360;
    const mjtNum yaw[4] = {std::cos(half_yaw_rad), 0, 0, std::sin(half_yaw_rad)};
    const mjtNum in_file[4] = {q[3], q[4], q[5], q[6]};
    mju_mulQuat(q + 3, yaw, in_file);
  }
  mj_forward(model_.get(), data.get());
  return data;
}

}  // namespace groundloop::sim
