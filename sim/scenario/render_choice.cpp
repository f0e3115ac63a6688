#include "sim/scenario/render_choice.h"

namespace groundloop::sim {
namespace {

RenderSettings settings_of(RenderProfile profile) {
  switch (profile) {
    case RenderProfile::kFast:
      return {
          .antialiasing = 0, .reflections = false, .shadows = false, .textures = TextureFilter::kNearestSize};
    case RenderProfile::kStandard:
      return {
          .antialiasing = 4, .reflections = true, .shadows = false, .textures = TextureFilter::kTrilinear};
    case RenderProfile::kFaithful:
      return {.antialiasing = 4, .reflections = true, .shadows = true, .textures = TextureFilter::kTrilinear};
  }
  return {};
}

}  // namespace

void RenderChoice::check(ConfigReader& reader) const {
  if (antialiasing && *antialiasing != 0 && *antialiasing != 2 && *antialiasing != 4)
    reader.problem("antialiasing", "one of: 0, 2, 4");
}

RenderSettings RenderChoice::settings() const {
  RenderSettings settings = settings_of(profile);
  settings.antialiasing = antialiasing.value_or(settings.antialiasing);
  settings.reflections = reflections.value_or(settings.reflections);
  settings.shadows = shadows.value_or(settings.shadows);
  settings.textures = textures.value_or(settings.textures);
  return settings;
}

}  // namespace groundloop::sim
