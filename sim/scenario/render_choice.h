#pragma once

#include <optional>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Three prices for an image; docs/rendering.md has their measured costs.
enum class RenderProfile { kFast, kStandard, kFaithful };

/// How a texture is read between the sizes that are stored of it (mipmaps).
enum class TextureFilter {
  kNearestSize,  ///< bilinear in the stored size nearest to the one needed
  kTrilinear,    ///< bilinear in the two sizes round the one needed, and between them
};

/// How images are made, every choice taken. Every combination gives the same bytes in every run.
struct RenderSettings {
  int antialiasing = 4;     ///< multisamples: 0 (none), 2 or 4
  bool reflections = true;  ///< MuJoCo reflects in one geom of the scene
  bool shadows = false;     ///< of the lights that cast them
  TextureFilter textures = TextureFilter::kTrilinear;

  bool operator==(const RenderSettings&) const = default;
};

/// `render:` a profile, and what to do otherwise than it says.
struct RenderChoice {
  RenderProfile profile = RenderProfile::kStandard;
  std::optional<int> antialiasing;
  std::optional<bool> reflections;
  std::optional<bool> shadows;
  std::optional<TextureFilter> textures;

  template <class Archive>
  void visit(Archive& a) {
    a("profile", profile, {.doc = "price of an image; the other keys change one thing of it"});
    a("antialiasing", antialiasing, {.min = 0, .max = 4, .doc = "samples a pixel: 0, 2 or 4"});
    a("reflections", reflections);
    a("shadows", shadows);
    a("textures", textures, {.doc = "how textures are filtered"});
  }
  void check(ConfigReader& reader) const;

  /// The profile's, with the changes.
  RenderSettings settings() const;
};

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::RenderProfile> {
  static constexpr std::array<std::pair<sim::RenderProfile, const char*>, 3> names = {
      {{sim::RenderProfile::kFast, "fast"},
       {sim::RenderProfile::kStandard, "standard"},
       {sim::RenderProfile::kFaithful, "faithful"}}};
};
template <>
struct EnumNames<sim::TextureFilter> {
  static constexpr std::array<std::pair<sim::TextureFilter, const char*>, 2> names = {
      {{sim::TextureFilter::kNearestSize, "nearest_size"}, {sim::TextureFilter::kTrilinear, "trilinear"}}};
};
}  // namespace groundloop
