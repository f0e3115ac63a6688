#include "sim/world/generate/furnishing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace groundloop::sim {
namespace {

constexpr double kDeepest_m = 0.97;      ///< what furniture reaches into a room
constexpr double kBackToBack_m = 1.98;   ///< depth of two pieces
constexpr double kNarrowest_m = 1.5;     ///< always left between the two sides of a room

using Maker = Piece (*)(const Palette&, Dice);

/// How a style fills its rooms.
struct Habits {
  std::vector<Maker> along_walls;  ///< repeated by weight
  std::vector<Maker> in_islands;
  double gap_min_m, gap_max_m;          ///< between two pieces along a wall
  double picture_gap_min_m, picture_gap_max_m;
  double aisle_m;
  double island_m;  ///< depth: one piece, or two back to back
  double island_chance;
};

Habits habits_of(WorldStyle style) {
  switch (style) {
    case WorldStyle::kClutter:
      return {{make_desk, make_bench, make_shelf, make_cartons, make_cartons, make_rack, make_cabinet, make_drawers,
               make_plant},
              {make_desk, make_desk, make_bench, make_cartons, make_shelf, make_rack, make_drawers},
              0.02, 0.25, 0.1, 0.5, 1.15, kDeepest_m, 1};
    case WorldStyle::kLowTexture:
      return {{make_cabinet, make_drawers, make_couch, make_desk, make_plant},
              {make_desk, make_desk, make_drawers, make_couch},
              0.4, 1.4, 0.5, 1.3, 1.5, kBackToBack_m, 0.8};
    default:
      return {{make_desk, make_desk, make_desk, make_shelf, make_shelf, make_cabinet, make_cabinet, make_drawers,
               make_bench, make_rack, make_plant, make_cartons, make_couch},
              {make_desk, make_desk, make_desk, make_desk, make_shelf, make_poster_board, make_drawers},
              0.05, 0.6, 0.15, 0.8, 1.35, kBackToBack_m, 0.9};
  }
}

/// Something that stands against a wall, or hangs on it.
struct Standing {
  double from_m, to_m, height_m;
};

class Furnisher {
 public:
  Furnisher(SceneWriter& scene, const FloorPlan& plan, WorldStyle style, const Palette& palette, uint64_t seed)
      : scene_(scene), plan_(plan), palette_(palette), habits_(habits_of(style)), seed_(seed),
        taken_(plan.keep_clear), standing_(plan.sides.size()) {}

  void fill_walls();
  void fill_corridor();
  void fill_islands();
  void hang_pictures();

 private:
  Dice next_dice() { return Dice(seed_, 1000 + pieces_++); }
  bool is_free(const Rect& floor) const {
    return std::none_of(taken_.begin(), taken_.end(), [&](const Rect& other) { return other.overlaps(floor); });
  }
  bool crosses_opening(const WallSide& side, double from_m, double to_m) const;
  void put(const Piece& piece, double x_m, double y_m, double yaw_deg);
  bool put_against(size_t side, double from_m, const Piece& piece);
  void fill_wall(size_t side, Dice dice);
  void fill_islands(const Rect& room, Dice dice);
  double put_island(double x_m, double y_m, double yaw_deg, double length_m, double depth_m, Dice& dice);
  void hang_pictures(size_t side, Dice dice);
  double furniture_height_m(size_t side, double from_m, double to_m) const;

  SceneWriter& scene_;
  const FloorPlan& plan_;
  const Palette& palette_;
  const Habits habits_;
  const uint64_t seed_;
  std::vector<Rect> taken_;
  std::vector<std::vector<Standing>> standing_;  ///< by side
  uint64_t pieces_ = 0;
};

bool Furnisher::crosses_opening(const WallSide& side, double from_m, double to_m) const {
  return std::any_of(side.openings.begin(), side.openings.end(), [&](const Opening& way) {
    return from_m < way.to_m + 0.1 && way.from_m - 0.1 < to_m;
  });
}

void Furnisher::put(const Piece& piece, double x_m, double y_m, double yaw_deg) {
  scene_.begin_body(fmt::format("{}_{}", piece.name, ++pieces_), x_m, y_m, yaw_deg);
  piece.draw(scene_);
  scene_.end_body();
}

bool Furnisher::put_against(size_t side, double from_m, const Piece& piece) {
  const WallSide& wall = plan_.sides[side];
  const double to_m = from_m + piece.width_m;
  const Rect floor = wall.floor(from_m, to_m, piece.depth_m);
  if (to_m > wall.length_m || crosses_opening(wall, from_m, to_m) || !is_free(floor)) return false;
  taken_.push_back(floor);
  standing_[side].push_back({from_m, to_m, piece.height_m});
  const double middle = (from_m + to_m) / 2;
  put(piece, wall.x_at(middle), wall.y_at(middle), wall.yaw_deg);
  return true;
}

void Furnisher::fill_wall(size_t side, Dice dice) {
  const WallSide& wall = plan_.sides[side];
  const Rect& room = plan_.rooms[wall.room];
  const double deepest = (std::min(room.width_m(), room.height_m()) - kNarrowest_m) / 2;
  const double door_at = dice.uniform(0, 2 * wall.length_m);  // on every second wall
  bool door_is_due = true;
  double s = dice.uniform(0.02, 0.4);
  while (s < wall.length_m - 0.4) {
    if (door_is_due && s > door_at) {
      door_is_due = false;
      const std::string texture = numbered(dice, "door", 2);
      if (put_against(side, s + 0.1, make_door(palette_, texture))) s += 1.4;
    }
    const Piece piece = dice.pick(habits_.along_walls)(palette_, next_dice());
    const bool put = piece.depth_m <= deepest && put_against(side, s, piece);
    s += put ? piece.width_m + dice.uniform(habits_.gap_min_m, habits_.gap_max_m) : 0.2;
  }
}

void Furnisher::fill_walls() {
  for (size_t side = 0; side < plan_.sides.size(); ++side) fill_wall(side, Dice(seed_, 100 + side));
}

/// The same doors and boards at the same distance all along; here and there something of its own.
void Furnisher::fill_corridor() {
  Dice dice(seed_, 99);
  const double pitch = dice.uniform(2.6, 3.6);
  const std::string door = numbered(dice, "door", 2);
  const std::string board = picture(scene_, dice, dice.chance(0.5) ? "cork_board" : "table_poster");
  const std::string sign = picture(scene_, dice, numbered(dice, "paper_poster", 4));
  for (size_t side = 0; side < plan_.sides.size(); ++side) {
    const WallSide& wall = plan_.sides[side];
    if (wall.length_m < 5) {  // an end
      put_against(side, (wall.length_m - 1.13) / 2, make_door(palette_, door));
      continue;
    }
    const int modules = static_cast<int>(wall.length_m / pitch);
    const double start = (wall.length_m - modules * pitch) / 2;
    for (int i = 0; i < modules; ++i) {
      const double s = start + i * pitch;
      put_against(side, s + 0.1, make_door(palette_, door));
      scene_.begin_body(fmt::format("notices_{}", ++pieces_), wall.x_at(s + 1.9), wall.y_at(s + 1.9), wall.yaw_deg);
      scene_.front(board, {0.5, 0.3, 0.012}, {0.1, -0.012, 1.35});
      scene_.front(sign, {0.1, 0.14, 0.006}, {-0.6, -0.006, 1.45});
      scene_.box(palette_.white, {0.08, 0.006, 0.0425}, {0.3, -0.006, 0.3});
      if (dice.chance(0.25)) scene_.drum(palette_.covers[0], 0.07, {0.75, -0.075, 0.45}, {0.75, -0.075, 0.9});
      scene_.end_body();
      standing_[side].push_back({s + 1.2, s + 2.55, 3});
    }
  }
}

/// @return length of what was put along the island, 0 when nothing was
double Furnisher::put_island(double x_m, double y_m, double yaw_deg, double length_m, double depth_m, Dice& dice) {
  const double yaw_rad = yaw_deg * std::numbers::pi / 180;
  const Maker maker = dice.pick(habits_.in_islands);
  const bool both_sides = depth_m >= kBackToBack_m;
  double used = 0;
  for (int i = dice.integer(1, 3); i > 0; --i) {
    const Maker rear_maker = dice.chance(0.7) ? maker : dice.pick(habits_.in_islands);
    const Piece front = maker(palette_, next_dice()), rear = rear_maker(palette_, next_dice());
    const double width = both_sides ? std::max(front.width_m, rear.width_m) : front.width_m;
    if (used + width > length_m || front.depth_m > depth_m) break;
    const double u = used + width / 2;
    const auto place = [&](const Piece& piece, double v, double turn_deg) {
      put(piece, x_m + u * std::cos(yaw_rad) - v * std::sin(yaw_rad),
          y_m + u * std::sin(yaw_rad) + v * std::cos(yaw_rad), yaw_deg + turn_deg);
    };
    if (both_sides) {
      place(front, -0.02, 0);
      place(rear, 0.02, 180);
    } else {
      place(front, front.depth_m / 2, 0);
    }
    used += width + 0.02;
  }
  return used;
}

void Furnisher::fill_islands(const Rect& room, Dice dice) {
  const Rect middle = room.grown(-(kDeepest_m + habits_.aisle_m));
  if (middle.width_m() < 0.8 || middle.height_m() < 0.8) return;
  const bool along_x = dice.chance(middle.width_m() >= middle.height_m() ? 0.75 : 0.25);
  const double along = along_x ? middle.width_m() : middle.height_m();
  const double across = along_x ? middle.height_m() : middle.width_m();
  const int rows = std::max(1, static_cast<int>((across + habits_.aisle_m) / (habits_.island_m + habits_.aisle_m)));
  const double pitch = across / rows, depth = std::min(habits_.island_m, rows == 1 ? across : pitch - habits_.aisle_m);
  for (int row = 0; row < rows; ++row) {
    // Spread so that the outermost rows keep the aisle, too.
    const double v = rows == 1 ? across / 2 : depth / 2 + row * (across - depth) / (rows - 1);
    double u = dice.uniform(0, 0.4);
    while (along - u > 0.8) {
      const double most = std::min(along - u, dice.uniform(1.5, 5));
      const double x = along_x ? middle.x_min_m + u : middle.x_min_m + v;
      const double y = along_x ? middle.y_min_m + v : middle.y_min_m + u;
      const double used =
          dice.chance(habits_.island_chance) ? put_island(x, y, along_x ? 0 : 90, most, depth, dice) : 0.5;
      u += (used > 0 ? used : 0.3) + habits_.aisle_m;
    }
  }
}

void Furnisher::fill_islands() {
  for (size_t room = 0; room < plan_.rooms.size(); ++room) fill_islands(plan_.rooms[room], Dice(seed_, 200 + room));
}

double Furnisher::furniture_height_m(size_t side, double from_m, double to_m) const {
  double highest = 0;
  for (const Standing& thing : standing_[side]) {
    if (thing.from_m < to_m && from_m < thing.to_m) highest = std::max(highest, thing.height_m);
  }
  return highest;
}

void Furnisher::hang_pictures(size_t side, Dice dice) {
  struct Print {
    const char* stem;
    int count;
    double half_w, half_h, smallest;
  };
  static const std::vector<Print> kPrints = {
      {"paper_poster", 4, 0.3, 0.45, 0.8}, {"paper_poster", 4, 0.42, 0.6, 1},   {"photo_poster", 3, 0.35, 0.35, 0.6},
      {"photo_poster", 3, 0.5, 0.4, 0.7},  {"table_poster", 0, 0.6, 0.35, 0.8}, {"map_poster", 0, 0.65, 0.35, 0.7},
      {"cork_board", 0, 0.6, 0.35, 0.7},   {"whiteboard", 0, 0.9, 0.5, 0.8},    {"window_view", 0, 0.9, 0.6, 0.8}};
  const WallSide& wall = plan_.sides[side];
  scene_.begin_body(fmt::format("pictures_{}", side + 1), wall.x_at(0), wall.y_at(0), wall.yaw_deg);
  double s = dice.uniform(0.2, 0.8);
  while (s < wall.length_m - 0.8) {
    const Print& print = dice.pick(kPrints);
    const bool window = std::string_view(print.stem) == "window_view";
    const double to = s + 2 * print.half_w, below = furniture_height_m(side, s - 0.05, to + 0.05);
    const double low = std::max(window ? 0.85 : dice.uniform(0.45, 1.1), below > 0 ? below + 0.12 : 0);
    const double middle = low + print.half_h;
    const bool fits = to < wall.length_m - 0.15 && middle + print.half_h < plan_.height_m - 0.15 &&
                      !crosses_opening(wall, s, to) && (!window || wall.outside);
    if (!fits) {
      s += 0.25;
      continue;
    }
    const std::string name = print.count > 0 ? numbered(dice, print.stem, print.count) : print.stem;
    scene_.front(picture(scene_, dice, name, print.smallest, window ? 0.25 : 0),
                 {print.half_w, print.half_h, 0.01}, {s + print.half_w, -0.01, middle});
    if (window) scene_.box(palette_.white, {print.half_w + 0.05, 0.04, 0.02}, {s + print.half_w, -0.04, low - 0.02});
    s = to + dice.uniform(habits_.picture_gap_min_m, habits_.picture_gap_max_m);
  }
  scene_.end_body();
}

void Furnisher::hang_pictures() {
  for (size_t side = 0; side < plan_.sides.size(); ++side) hang_pictures(side, Dice(seed_, 300 + side));
}

}  // namespace

void furnish(SceneWriter& scene, const FloorPlan& plan, WorldStyle style, const Palette& palette, uint64_t seed) {
  Furnisher furnisher(scene, plan, style, palette, seed);
  if (style == WorldStyle::kCorridor) {
    furnisher.fill_corridor();
  } else {
    furnisher.fill_walls();
    furnisher.fill_islands();
    furnisher.hang_pictures();
  }
}

}  // namespace groundloop::sim
