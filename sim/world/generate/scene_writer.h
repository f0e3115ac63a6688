#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sim/world/generate/dice.h"

namespace groundloop::sim {

using Vec3 = std::array<double, 3>;

/// How a material of models/generated is laid on things.
struct Finish {
  std::string texture;            ///< file in models/generated without its ending; empty: a plain colour
  bool cube = false;              ///< same picture on each side of a box
  double repeat_x = 1;            ///< pictures across the face, or a metre when uniform
  double repeat_y = 1;
  bool uniform = false;           ///< repeats count by the metre
  Vec3 rgb = {1, 1, 1};           ///< multiplies the texture
  double reflectance = 0;
  double emission = 0;
};

/// Writes an MJCF world piece by piece. Every piece of furniture is a body whose origin is on the floor at the
/// middle of its back; x is to the right and -y to the front for someone who stands before it.
class SceneWriter {
 public:
  explicit SceneWriter(std::string name) : name_(std::move(name)) {}

  /// Names a material for a finish; equal finishes are one material.
  std::string material(const Finish& finish);

  void light(const Vec3& direction, double grey, bool casts_shadow);
  void set_ambient(double grey) { ambient_ = grey; }

  /// Geoms go into the body begun last, until it ends.
  void begin_body(const std::string& name, double x_m, double y_m, double yaw_deg);
  void end_body();

  /// A box of half sizes, turned by yaw about the vertical.
  void box(const std::string& material, const Vec3& half_m, const Vec3& centre_m, double yaw_deg = 0);
  /// A box out of a robot's reach: nothing touches it.
  void decor(const std::string& material, const Vec3& half_m, const Vec3& centre_m, double yaw_deg = 0);
  /// An upright board facing the front: half width, half height, half thickness.
  void panel(const std::string& material, const Vec3& half_m, const Vec3& centre_m);
  /// A picture that faces the front, stuck on something.
  void front(const std::string& material, const Vec3& half_m, const Vec3& centre_m);
  /// A picture that faces the back.
  void rear(const std::string& material, const Vec3& half_m, const Vec3& centre_m);
  void drum(const std::string& material, double radius_m, const Vec3& from_m, const Vec3& to_m);
  void rod(const std::string& material, double radius_m, const Vec3& from_m, const Vec3& to_m);
  void ball(const std::string& material, double radius_m, const Vec3& centre_m);
  void floor(const std::string& material, double half_x_m, double half_y_m, double x_m, double y_m);

  /// The whole file. @param texture_folder  where the textures are
  /// @param comment  first line of the file
  std::string text(const std::string& texture_folder, const std::string& comment) const;

 private:
  void geom(const std::string& attributes);

  std::string name_;
  std::string assets_;
  std::string lights_;
  std::string bodies_;
  double ambient_ = 0.38;
  int depth_ = 2;
  std::map<std::string, std::string> materials_;  ///< attributes -> name
  std::map<std::string, std::string> textures_;   ///< attributes -> name
};

}  // namespace groundloop::sim
