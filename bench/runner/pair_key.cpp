#include "bench/runner/pair_key.h"

#include <mujoco/mjxmacro.h>

#include <opencv2/core/utility.hpp>

#include "bench/runner/pixel_sources.h"
#include "bench/runner/provenance.h"

namespace groundloop::bench {
namespace {

/// Every number, text and array of a compiled model.
void add_model(sim::KeyBuilder& key, const mjModel& model) {
#define X(name) key.add(model.name);
  MJMODEL_INTS
#undef X
  // These hold numbers only, without gaps between them.
  key.add(reinterpret_cast<const uint8_t*>(&model.vis), sizeof model.vis);
  key.add(reinterpret_cast<const uint8_t*>(&model.stat), sizeof model.stat);
  MJMODEL_POINTERS_PREAMBLE((&model))
#define X(type, name, rows, cols)                       \
  key.add(reinterpret_cast<const uint8_t*>(model.name), \
          sizeof(type) * static_cast<size_t>(model.rows) * static_cast<size_t>(cols));
  MJMODEL_POINTERS
#undef X
}

/// What a model without textures lacks: textures, by what their files hold, and what wears them.
void add_textures(sim::KeyBuilder& key, const sim::MjcfElement& scene) {
  sim::MjcfElement::walk(scene, [&key](const sim::MjcfElement& element) {
    const bool is_texture = element.tag == "texture";
    if (!is_texture && element.find("texture") == nullptr) return;
    key.add(element.tag);
    for (const auto& [name, value] : element.attributes) {
      key.add(name);
      key.add(is_texture && name.starts_with("file") ? sha256_of_file(value) : value);
    }
  });
}

/// Where everything that can be drawn is.
void add_state(sim::KeyBuilder& key, const mjModel& model, const mjData& state) {
  const auto add = [&](const mjtNum* values, int count) { key.add(values, static_cast<size_t>(count)); };
  add(state.geom_xpos, 3 * model.ngeom);
  add(state.geom_xmat, 9 * model.ngeom);
  add(state.light_xpos, 3 * model.nlight);
  add(state.light_xdir, 3 * model.nlight);
  if (model.nskin == 0) return;
  add(state.xpos, 3 * model.nbody);
  add(state.xquat, 4 * model.nbody);
}

void add_lights(sim::KeyBuilder& key, const sim::LightFactors& lights) {
  key.add(lights.light.data(), lights.light.size());
  key.add(lights.ambient);
}

void add_pose(sim::KeyBuilder& key, const slam::Pose& pose) {
  key.add(pose.matrix().data(), static_cast<size_t>(pose.matrix().size()));
}

void add_sub_frames(sim::KeyBuilder& key, const mjModel& model,
                    const std::vector<sim::SubFrame>& sub_frames) {
  key.add(sub_frames.size());
  for (const sim::SubFrame& sub : sub_frames) {
    add_state(key, model, *sub.state);
    add_lights(key, sub.lights);
    add_pose(key, sub.T_world_camera);
  }
}

/// Whether all that a fault does is seen in states and poses, or happens to finished pairs on their way.
bool leaves_images(const sim::Fault& fault) {
  return fault.drop || fault.duplicate || fault.late || fault.swap || fault.trigger_offset || fault.knock ||
         fault.wheel_slip || fault.kidnap || fault.encoder;
}

/// Faults that are not in force change nothing; of one that is, its place in the list decides its chance.
void add_faults(sim::KeyBuilder& key, const std::vector<sim::Fault>& faults, double time_s) {
  bool any = false;
  for (size_t i = 0; i < faults.size(); ++i) {
    const sim::Fault& fault = faults[i];
    if (!fault.active(time_s) || leaves_images(fault)) continue;
    any = true;
    key.add(i);
    key.add(to_yaml(fault));
  }
  if (any) key.add(time_s);
}

}  // namespace

sim::KeyBuilder run_key(const sim::World& world, const sim::HeadModel& head, const sim::Scenario& scenario,
                        const sim::RendererInfo& renderer) {
  sim::KeyBuilder key;
  key.add(kPixelSources);
  key.add(__VERSION__);
  key.add(mj_versionString());
  key.add(cv::getVersionString());
  key.add(instruction_set());
  key.add(renderer.renderer);
  key.add(renderer.version);
  key.add(renderer.samples);
  const sim::RenderSettings settings = scenario.render.settings();
  key.add(settings.antialiasing);
  key.add(settings.reflections);
  key.add(settings.shadows);
  key.add(settings.textures);
  sim::HeadModel seen = head;
  seen.summary.clear();
  key.add(to_yaml(seen));
  key.add(scenario.seed);
  add_model(key, world.model());
  add_textures(key, sim::compose_scene(scenario).mjcf);
  return key;
}

sim::ContentKey pair_key(const sim::KeyBuilder& run, const sim::World& world, const sim::Scenario& scenario,
                         const sim::Exposure& exposure, const std::optional<sim::ExposureSetting>& setting) {
  const mjModel& model = world.model();
  sim::KeyBuilder key(run);
  key.add(exposure.index);
  add_state(key, model, *exposure.state);
  key.add(exposure.state_right != exposure.state);
  if (exposure.state_right != exposure.state) add_state(key, model, *exposure.state_right);
  add_lights(key, exposure.lights);
  add_pose(key, exposure.T_world_left);
  add_pose(key, exposure.T_world_right);
  add_sub_frames(key, model, exposure.left_sub_frames);
  add_sub_frames(key, model, exposure.right_sub_frames);
  add_faults(key, scenario.faults, static_cast<double>(exposure.stamp_ns) * 1e-9);
  if (setting) {
    key.add(setting->time_s);
    key.add(setting->gain_db);
  }
  return key.key();
}

}  // namespace groundloop::bench
