#pragma once

#include <functional>
#include <string>

#include "sim/world/generate/dice.h"
#include "sim/world/generate/scene_writer.h"

namespace groundloop::sim {

/// A thing to put into a room: how much floor it takes, and how it is drawn into the body begun last (origin on
/// the floor at the middle of its back, front at -y).
struct Piece {
  std::string name;
  double width_m = 0;
  double depth_m = 0;
  double height_m = 0;
  std::function<void(SceneWriter&)> draw;
};

/// What the things of one house are made of: chosen once, so that they match.
struct Palette {
  Palette(SceneWriter& scene, Dice& dice, bool plain);

  bool plain;  ///< nothing printed, nothing patterned
  std::string top, wood, metal, back, black, chrome, white, paper, fabric, frame;
  std::vector<std::string> covers;
  std::vector<std::string> cartons;
};

/// A picture of models/generated with light and colour of its own, or only a part of it.
/// @param texture   file name without its ending; `{1..n}` is not expanded: see numbered()
/// @param smallest  part of the picture's width and height that may be shown, 1 for all of it
std::string picture(SceneWriter& scene, Dice& dice, const std::string& texture, double smallest = 1,
                    double emission = 0);
/// "book_row_3" of ("book_row", 4).
std::string numbered(Dice& dice, const std::string& stem, int count);

Piece make_desk(const Palette& palette, Dice dice);
Piece make_bench(const Palette& palette, Dice dice);
Piece make_cabinet(const Palette& palette, Dice dice);
Piece make_rack(const Palette& palette, Dice dice);
Piece make_shelf(const Palette& palette, Dice dice);
Piece make_drawers(const Palette& palette, Dice dice);
Piece make_cartons(const Palette& palette, Dice dice);
Piece make_poster_board(const Palette& palette, Dice dice);
Piece make_plant(const Palette& palette, Dice dice);
Piece make_couch(const Palette& palette, Dice dice);
/// A closed door in its frame, flat on the wall.
Piece make_door(const Palette& palette, const std::string& texture);

}  // namespace groundloop::sim
