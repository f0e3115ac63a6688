#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

enum class WorldStyle { kOffice, kClutter, kCorridor, kDoorway, kLowTexture };
enum class FloorKind { kAny, kTiles, kCarpet, kWood, kConcrete };

/// `world: {generate: {...}}`: a furnished building drawn from a seed (sim/world/generate).
struct WorldRecipe {
  std::optional<uint64_t> seed;  ///< none: the scenario's
  WorldStyle style = WorldStyle::kOffice;
  std::vector<double> size_m;  ///< along x and y, inside; empty: from the seed
  FloorKind floor = FloorKind::kAny;
  std::optional<double> reflectance;             ///< of the floor; none: from the seed
  std::string textures = "../models/generated";  ///< folder, relative to the scenario file

  template <class Archive>
  void visit(Archive& a) {
    a("seed", seed, {.doc = "the scenario's when not given"});
    a("style", style);
    a("size_m", size_m, {.min = 2, .max = 60, .doc = "inside, along x and y; from the seed when empty"});
    a("floor", floor);
    a("reflectance", reflectance,
      {.min = 0, .max = 0.5, .doc = "of the floor; from the seed when not given"});
    a("textures", textures, {.doc = "folder of the house's textures, relative to this file"});
  }
  void check(ConfigReader& reader) const;
};

/// `plan: {generate: {...}}`: a way of straights and arcs through any world, drawn from a seed
/// (sim/generate).
struct PlanRecipe {
  std::optional<uint64_t> seed;  ///< none: the scenario's
  double length_m = 20;          ///< of the whole way
  int laps = 0;                  ///< times round the same loop; 0: not closed
  double min_radius_m = 0.5;     ///< of arcs
  double clearance_m = 0.12;     ///< kept from everything
  double min_texture = 0.15;     ///< part of the image that must show texture, all along

  template <class Archive>
  void visit(Archive& a) {
    a("seed", seed, {.doc = "the scenario's when not given"});
    a("length_m", length_m, {.min = 1, .max = 1000, .doc = "of the whole way; about, when it is laps"});
    a("laps", laps, {.min = 0, .max = 100, .doc = "times round the same loop; 0: not closed"});
    a("min_radius_m", min_radius_m, {.min = 0.3, .max = 10, .doc = "of arcs"});
    a("clearance_m", clearance_m, {.min = 0.05, .max = 2, .doc = "kept from everything"});
    a("min_texture", min_texture,
      {.min = 0, .max = 1, .doc = "part of the image that must show texture, all along"});
  }
};

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::WorldStyle> {
  static constexpr std::array<std::pair<sim::WorldStyle, const char*>, 5> names = {
      {{sim::WorldStyle::kOffice, "office"},
       {sim::WorldStyle::kClutter, "clutter"},
       {sim::WorldStyle::kCorridor, "corridor"},
       {sim::WorldStyle::kDoorway, "doorway"},
       {sim::WorldStyle::kLowTexture, "low_texture"}}};
};
template <>
struct EnumNames<sim::FloorKind> {
  static constexpr std::array<std::pair<sim::FloorKind, const char*>, 5> names = {
      {{sim::FloorKind::kAny, "any"},
       {sim::FloorKind::kTiles, "tiles"},
       {sim::FloorKind::kCarpet, "carpet"},
       {sim::FloorKind::kWood, "wood"},
       {sim::FloorKind::kConcrete, "concrete"}}};
};
}  // namespace groundloop
