#include "sim/world/generate/scene_writer.h"

#include <fmt/format.h>

namespace groundloop::sim {
namespace {

/// Tenths of a millimetre, without trailing zeros.
std::string number(double value) {
  std::string text = fmt::format("{:.4f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string numbers(const Vec3& v) {
  return number(v[0]) + " " + number(v[1]) + " " + number(v[2]);
}

std::string boxed(const char* box_class, const std::string& material, const Vec3& half, const Vec3& centre) {
  const std::string named = *box_class == 0 ? "" : fmt::format("class=\"{}\" ", box_class);
  return fmt::format("{}material=\"{}\" size=\"{}\" pos=\"{}\"", named, material, numbers(half),
                     numbers(centre));
}

std::string turned(double yaw_deg) {
  return yaw_deg == 0 ? "" : fmt::format(" euler=\"0 0 {}\"", number(yaw_deg));
}

std::string along(const char* shape, const std::string& material, double radius, const Vec3& from,
                  const Vec3& to) {
  return fmt::format("class=\"{}\" material=\"{}\" size=\"{}\" fromto=\"{} {}\"", shape, material,
                     number(radius), numbers(from), numbers(to));
}

constexpr const char* kDefaults = R"(  <default>
    <geom type="box"/>
    <material specular="0" shininess="0.1"/>
    <default class="panel">  <!-- an upright board: x right, y up, z out to the viewer at -y -->
      <geom xyaxes="1 0 0 0 0 1"/>
      <default class="front"><geom contype="0" conaffinity="0"/></default>  <!-- a picture stuck on something -->
    </default>
    <default class="rear"><geom xyaxes="-1 0 0 0 0 1" contype="0" conaffinity="0"/></default>
    <default class="decor"><geom contype="0" conaffinity="0"/></default>  <!-- out of a robot's reach -->
    <default class="rod"><geom type="capsule"/></default>
    <default class="drum"><geom type="cylinder"/></default>
    <default class="ball"><geom type="sphere"/></default>
  </default>
)";

}  // namespace

std::string SceneWriter::material(const Finish& finish) {
  std::string attributes;
  if (!finish.texture.empty()) {
    const std::string texture = fmt::format("type=\"{}\" file=\"{}.png\"", finish.cube ? "cube" : "2d",
                                            finish.texture);
    const auto [known, is_new] =
        textures_.try_emplace(texture, finish.texture + (finish.cube ? "_cube" : ""));
    if (is_new) assets_ += fmt::format("    <texture name=\"{}\" {}/>\n", known->second, texture);
    attributes += fmt::format("texture=\"{}\"", known->second);
    if (!finish.cube) {
      attributes += fmt::format(" texrepeat=\"{} {}\"", number(finish.repeat_x), number(finish.repeat_y));
      if (finish.uniform) attributes += " texuniform=\"true\"";
    }
  }
  attributes += fmt::format(" rgba=\"{} 1\"", numbers(finish.rgb));
  if (finish.reflectance > 0) attributes += fmt::format(" reflectance=\"{}\"", number(finish.reflectance));
  if (finish.emission > 0) attributes += fmt::format(" emission=\"{}\"", number(finish.emission));

  const std::string stem = finish.texture.empty() ? "colour" : finish.texture;
  const auto [known, is_new] =
      materials_.try_emplace(attributes, fmt::format("{}.{}", stem, materials_.size() + 1));
  if (is_new) assets_ += fmt::format("    <material name=\"{}\" {}/>\n", known->second, attributes);
  return known->second;
}

void SceneWriter::light(const Vec3& direction, double grey, bool casts_shadow) {
  const std::string level = number(grey);
  lights_ += fmt::format(
      "    <light directional=\"true\" castshadow=\"{}\" pos=\"0 0 2.5\" dir=\"{}\" diffuse=\"{} {} {}\" "
      "specular=\"0 0 0\"/>\n",
      casts_shadow, numbers(direction), level, level, level);
}

void SceneWriter::begin_body(const std::string& name, double x_m, double y_m, double yaw_deg) {
  bodies_ += fmt::format("{:{}}<body name=\"{}\" pos=\"{} {} 0\"{}>\n", "", 2 * depth_, name, number(x_m),
                         number(y_m), turned(yaw_deg));
  ++depth_;
}

void SceneWriter::end_body() {
  --depth_;
  bodies_ += fmt::format("{:{}}</body>\n", "", 2 * depth_);
}

void SceneWriter::geom(const std::string& attributes) {
  bodies_ += fmt::format("{:{}}<geom {}/>\n", "", 2 * depth_, attributes);
}

void SceneWriter::box(const std::string& material, const Vec3& half_m, const Vec3& centre_m, double yaw_deg) {
  geom(boxed("", material, half_m, centre_m) + turned(yaw_deg));
}
void SceneWriter::decor(const std::string& material, const Vec3& half_m, const Vec3& centre_m,
                        double yaw_deg) {
  geom(boxed("decor", material, half_m, centre_m) + turned(yaw_deg));
}
void SceneWriter::panel(const std::string& material, const Vec3& half_m, const Vec3& centre_m) {
  geom(boxed("panel", material, half_m, centre_m));
}
void SceneWriter::front(const std::string& material, const Vec3& half_m, const Vec3& centre_m) {
  geom(boxed("front", material, half_m, centre_m));
}
void SceneWriter::rear(const std::string& material, const Vec3& half_m, const Vec3& centre_m) {
  geom(boxed("rear", material, half_m, centre_m));
}
void SceneWriter::drum(const std::string& material, double radius_m, const Vec3& from_m, const Vec3& to_m) {
  geom(along("drum", material, radius_m, from_m, to_m));
}
void SceneWriter::rod(const std::string& material, double radius_m, const Vec3& from_m, const Vec3& to_m) {
  geom(along("rod", material, radius_m, from_m, to_m));
}
void SceneWriter::ball(const std::string& material, double radius_m, const Vec3& centre_m) {
  geom(fmt::format("class=\"ball\" material=\"{}\" size=\"{}\" pos=\"{}\"", material, number(radius_m),
                   numbers(centre_m)));
}
void SceneWriter::floor(const std::string& material, double half_x_m, double half_y_m, double x_m,
                        double y_m) {
  geom(fmt::format("name=\"floor\" type=\"plane\" material=\"{}\" size=\"{} {} 1\" pos=\"{} {} 0\"", material,
                   number(half_x_m), number(half_y_m), number(x_m), number(y_m)));
}

std::string SceneWriter::text(const std::string& texture_folder, const std::string& comment) const {
  const std::string grey = number(ambient_);
  return fmt::format(R"(<!-- {} -->
<mujoco model="{}">
  <compiler angle="degree" texturedir="{}"/>
  <statistic extent="10" center="0 0 1"/>
  <visual>
    <!-- Directional lights shade every face evenly, so that few quads are enough. -->
    <quality numquads="1" numslices="16" numstacks="8" shadowsize="2048"/>
    <headlight ambient="{} {} {}" diffuse="0 0 0" specular="0 0 0"/>
  </visual>
{}  <asset>
{}  </asset>
  <worldbody>
{}{}  </worldbody>
</mujoco>
)",
                     comment, name_, texture_folder, grey, grey, grey, kDefaults, assets_, lights_, bodies_);
}

}  // namespace groundloop::sim
