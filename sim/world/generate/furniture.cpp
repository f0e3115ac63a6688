#include "sim/world/generate/furniture.h"

#include <fmt/format.h>

#include <algorithm>

namespace groundloop::sim {
namespace {

constexpr double kSheet_m = 0.003;  ///< half thickness of a picture; its back is inside of what carries it

void draw_legs(SceneWriter& scene, const Palette& p, double half_x, double depth, double top) {
  for (const double x : {-half_x, half_x}) {
    for (const double y : {-0.06, -(depth - 0.06)}) {
      scene.box(p.metal, {0.025, 0.025, top / 2}, {x, y, top / 2});
    }
  }
}

/// A box with a picture on its front, its lower edge at z.
void draw_faced_box(SceneWriter& scene, const std::string& body, const std::string& face, const Vec3& half,
                    double x, double y, double z, double border) {
  scene.box(body, half, {x, y, z + half[2]});
  scene.front(face, {half[0] - border, half[2] - border, kSheet_m}, {x, y - half[1] - kSheet_m + 0.001, z + half[2]});
}

void draw_screen(SceneWriter& scene, const Palette& p, Dice& dice, double x, double y, double z) {
  scene.decor(p.black, {0.11, 0.08, 0.0075}, {x, y, z + 0.0075});
  scene.decor(p.black, {0.025, 0.02, 0.08}, {x, y + 0.03, z + 0.095});
  scene.decor(p.black, {0.26, 0.0175, 0.16}, {x, y, z + 0.29});
  if (p.plain) return;
  const std::string shown = numbered(dice, dice.chance(0.5) ? "code_screen" : "plot_screen", 2);
  scene.front(picture(scene, dice, shown, 0.7, 0.5), {0.245, 0.145, 0.002}, {x, y - 0.0188, z + 0.29});
}

void draw_chair(SceneWriter& scene, const Palette& p, double x, double y) {
  for (const auto& [dx, dy] : {std::pair(0.17, 0.17), {-0.17, 0.17}, {-0.17, -0.17}, {0.17, -0.17}}) {
    scene.rod(p.black, 0.018, {x, y, 0.09}, {x + dx, y + dy, 0.045});
    scene.ball(p.black, 0.028, {x + dx, y + dy, 0.028});
  }
  scene.drum(p.chrome, 0.025, {x, y, 0.08}, {x, y, 0.43});
  scene.box(p.fabric, {0.21, 0.2, 0.035}, {x, y, 0.455});
  scene.box(p.black, {0.03, 0.015, 0.15}, {x, y - 0.205, 0.6});
  scene.box(p.fabric, {0.2, 0.025, 0.2}, {x, y - 0.215, 0.82});
}

/// Papers, books, a mug: what lies about on a top of this width.
void draw_litter(SceneWriter& scene, const Palette& p, Dice& dice, double half_x, double y, double z) {
  if (p.plain) return;
  const int sheets = dice.integer(1, 2);
  for (int i = 0; i < sheets; ++i) {
    const double half = dice.uniform(0.12, 0.18);
    scene.decor(picture(scene, dice, numbered(dice, "papers", 2), 0.6), {half, half, 0.0015 + 0.001 * i},
                {dice.uniform(-half_x + 0.2, half_x - 0.2), y, z + 0.0015 + 0.001 * i}, dice.uniform(-20, 20));
  }
  const double x = dice.uniform(-half_x + 0.2, half_x - 0.2);
  double level = z + 0.006;
  for (int i = dice.integer(0, 4); i > 0; --i) {
    scene.decor(dice.pick(p.covers), {dice.uniform(0.09, 0.12), dice.uniform(0.08, 0.1), 0.0175},
                {x, y + 0.1, level + 0.0175}, dice.uniform(-15, 15));
    level += 0.035;
  }
  if (dice.chance(0.5)) {
    const double at = dice.uniform(-half_x + 0.1, half_x - 0.1);
    scene.drum(dice.pick(p.covers), 0.04, {at, y - 0.08, z}, {at, y - 0.08, z + 0.09});
  }
}

void draw_instrument(SceneWriter& scene, const Palette& p, Dice& dice, double x, double y, double z) {
  const bool scope = dice.chance(0.5);
  const Vec3 half = scope ? Vec3{0.19, 0.14, 0.125} : Vec3{0.175, 0.13, 0.08};
  const std::string face =
      p.plain ? p.black : picture(scene, dice, numbered(dice, scope ? "oscilloscope" : "power_supply", 2));
  draw_faced_box(scene, p.metal, face, half, x, y, z, 0.005);
}

void draw_cartons(SceneWriter& scene, const Palette& p, Dice& dice, double half_x, double y, double z,
                  double room_m) {
  const Vec3 half = {std::min(dice.uniform(0.13, 0.22), half_x), dice.uniform(0.1, 0.15),
                     std::min(dice.uniform(0.07, 0.14), room_m / 2)};
  const double slack = half_x - half[0];
  scene.box(dice.pick(p.cartons), half, {dice.uniform(-slack, slack), y, z + half[2]}, dice.uniform(-4, 4));
}

/// What stands on one board of a shelf.
void draw_shelf_row(SceneWriter& scene, const Palette& p, Dice& dice, double half_x, double depth, double z,
                    double free_m) {
  if (p.plain || dice.chance(0.2)) {
    draw_cartons(scene, p, dice, half_x, -depth / 2, z, free_m - 0.05);
    return;
  }
  const bool books = dice.chance(0.65);
  const std::string face =
      picture(scene, dice, books ? numbered(dice, "book_row", 4) : numbered(dice, "binder_row", 2), 0.6);
  const double half_w = half_x * dice.uniform(0.7, 1), half_h = std::min(0.14, (free_m - 0.03) / 2);
  const double x = (half_x - half_w) * (dice.chance(0.5) ? 1 : -1), half_d = depth / 2 - dice.uniform(0.03, 0.06);
  scene.box(p.paper, {half_w, half_d, half_h - 0.01}, {x, -half_d - 0.015, z + half_h - 0.01});
  scene.front(face, {half_w, half_h, kSheet_m}, {x, -2 * half_d - 0.015 - kSheet_m + 0.001, z + half_h});
}

}  // namespace

Piece make_desk(const Palette& p, Dice dice) {
  const double width = dice.uniform(1.2, 1.8), depth = dice.uniform(0.7, 0.8);
  const bool chair = dice.chance(0.7);
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    const double half = width / 2, top = 0.725;
    scene.box(p.top, {half, depth / 2, 0.015}, {0, -depth / 2, top});
    draw_legs(scene, p, half - 0.05, depth, top - 0.015);
    scene.panel(p.back, {half - 0.08, 0.21, 0.01}, {0, -0.1, 0.46});
    const double side = d.chance(0.5) ? 1 : -1;
    const std::string drawers = p.plain ? p.white : picture(scene, d, numbered(d, "drawers", 2));
    draw_faced_box(scene, p.metal, drawers, {0.2, depth / 2 - 0.06, 0.28}, side * (half - 0.3), -depth / 2, 0.06,
                   0.012);
    const std::string computer = p.plain ? p.white : picture(scene, d, "rack_panels_2", 0.5);
    draw_faced_box(scene, p.black, computer, {0.09, 0.2, 0.2}, -side * (half - 0.2), -depth / 2, 0.03, 0.01);
    const int screens = width > 1.45 ? d.integer(1, 2) : 1;
    for (int i = 0; i < screens; ++i) {
      draw_screen(scene, p, d, screens == 1 ? d.uniform(-0.2, 0.2) : (i == 0 ? -0.3 : 0.3), -0.22, top + 0.015);
    }
    if (!p.plain) {
      scene.decor(picture(scene, d, "keyboard"), {0.215, 0.07, 0.008}, {d.uniform(-0.1, 0.1), -0.47, top + 0.023},
                  d.uniform(-5, 5));
    }
    draw_litter(scene, p, d, half, -0.5, top + 0.015);
    if (chair) draw_chair(scene, p, -side * 0.1, -depth + 0.12);
  };
  return {"desk", width, depth + (chair ? 0.16 : 0.0), 1.2, draw};
}

Piece make_bench(const Palette& p, Dice dice) {
  const double width = dice.uniform(1.4, 2.4), depth = 0.75;
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    const double half = width / 2, top = 0.835;
    scene.box(p.top, {half, depth / 2, 0.015}, {0, -depth / 2, top});
    draw_legs(scene, p, half - 0.05, depth, top - 0.015);
    scene.panel(p.back, {half - 0.08, 0.21, 0.01}, {0, -0.1, 0.46});
    for (double x = -half + 0.3; x < half - 0.25; x += 0.45) {
      const std::string drawers = p.plain ? p.white : picture(scene, d, numbered(d, "drawers", 2));
      if (d.chance(0.5)) {
        draw_faced_box(scene, p.metal, drawers, {0.2, 0.3, 0.32}, x, -0.38, 0.06, 0.012);
      }
      if (d.chance(0.7)) draw_instrument(scene, p, d, x, -0.3, top + 0.015);
    }
    draw_litter(scene, p, d, half, -0.55, top + 0.015);
  };
  return {"bench", width, depth, 1.15, draw};
}

Piece make_cabinet(const Palette& p, Dice dice) {
  const double width = dice.uniform(0.8, 1.0), depth = dice.uniform(0.4, 0.5);
  const double height = dice.chance(0.6) ? dice.uniform(1.8, 2.0) : dice.uniform(1.0, 1.3);
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    const double half_h = (height - 0.06) / 2;
    scene.box(p.black, {width / 2 - 0.03, depth / 2 - 0.02, 0.03}, {0, -depth / 2 + 0.01, 0.03});
    const std::string doors = p.plain ? p.metal : picture(scene, d, numbered(d, "cabinet_doors", 2));
    draw_faced_box(scene, p.metal, doors, {width / 2, depth / 2, half_h}, 0, -depth / 2, 0.06, 0.01);
    if (d.chance(0.6)) draw_cartons(scene, p, d, width / 2 - 0.05, -depth / 2, height, 0.3);
  };
  return {"cabinet", width, depth, height, draw};
}

Piece make_rack(const Palette& p, Dice dice) {
  const double width = 0.6, depth = dice.uniform(0.6, 0.75), height = dice.uniform(1.3, 1.9);
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    for (const double x : {-0.22, 0.22}) {
      for (const double y : {-0.07, -(depth - 0.07)}) scene.ball(p.black, 0.04, {x, y, 0.04});
    }
    const std::string panels = p.plain ? p.metal : picture(scene, d, numbered(d, "rack_panels", 3), 0.7);
    draw_faced_box(scene, p.black, panels, {width / 2, depth / 2, (height - 0.08) / 2}, 0, -depth / 2, 0.08, 0.02);
  };
  return {"rack", width, depth, height, draw};
}

Piece make_shelf(const Palette& p, Dice dice) {
  const double width = dice.uniform(0.9, 1.3), depth = dice.uniform(0.3, 0.36);
  const int rows = dice.integer(3, 5);
  const double step = dice.uniform(0.34, 0.39), height = 0.07 + rows * step + 0.0125;
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    const double half = width / 2;
    for (const double x : {-half + 0.015, half - 0.015}) {
      scene.box(p.wood, {0.015, depth / 2, height / 2}, {x, -depth / 2, height / 2});
    }
    scene.panel(p.back, {half - 0.031, height / 2 - 0.005, 0.006}, {0, -0.006, height / 2});
    for (int row = 0; row <= rows; ++row) {
      const double z = 0.07 + row * step;
      scene.box(p.wood, {half - 0.031, depth / 2 - 0.012, 0.0125}, {0, -depth / 2 - 0.005, z - 0.001});
      if (row < rows) draw_shelf_row(scene, p, d, half - 0.05, depth, z + 0.0115, step - 0.025);
    }
    if (d.chance(0.4)) draw_cartons(scene, p, d, half - 0.1, -depth / 2, height - 0.001, 0.25);
  };
  return {"shelf", width, depth, height, draw};
}

Piece make_drawers(const Palette& p, Dice dice) {
  const double width = dice.uniform(0.8, 1.2), depth = 0.45, height = dice.uniform(0.7, 0.95);
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    scene.box(p.wood, {width / 2, depth / 2, height / 2}, {0, -depth / 2, height / 2});
    for (const double x : {-width / 4, width / 4}) {
      scene.front(p.plain ? p.white : picture(scene, d, numbered(d, "drawers", 2)),
                  {width / 4 - 0.01, height / 2 - 0.03, kSheet_m}, {x, -depth - kSheet_m + 0.001, height / 2});
    }
    draw_litter(scene, p, d, width / 2, -0.22, height);
  };
  return {"drawers", width, depth, height, draw};
}

Piece make_cartons(const Palette& p, Dice dice) {
  const double width = dice.uniform(0.6, 1.1), depth = 0.5;
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    for (double x = -width / 2 + 0.26; x < width / 2 - 0.2; x += 0.47) {
      double level = 0;
      for (int i = d.integer(1, 4); i > 0; --i) {
        const Vec3 half = {d.uniform(0.16, 0.2), d.uniform(0.14, 0.18), d.uniform(0.1, 0.17)};
        scene.box(d.pick(p.cartons), half, {x, -0.25, level + half[2]}, d.uniform(-8, 8));
        level += 2 * half[2];
      }
    }
  };
  return {"cartons", width, depth, 1.2, draw};
}

Piece make_poster_board(const Palette& p, Dice dice) {
  const double width = dice.uniform(1.0, 1.5), depth = 0.44;
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    const double half = width / 2, y = -depth / 2;
    for (const double x : {-half + 0.02, half - 0.02}) {
      scene.box(p.chrome, {0.02, 0.02, 0.85}, {x, y, 0.85});
      scene.box(p.chrome, {0.02, 0.2, 0.015}, {x, y, 0.015});
    }
    scene.panel(p.fabric, {half - 0.041, 0.65, 0.015}, {0, y, 1.02});
    if (p.plain) return;
    for (const double side : {-1.0, 1.0}) {
      for (const double x : {-half / 2, half / 2}) {
        const Vec3 sheet = {std::min(0.27, half / 2 - 0.05), 0.4, kSheet_m};
        const Vec3 at = {x, y + side * (0.015 + kSheet_m - 0.001), d.uniform(0.85, 1.15)};
        const std::string print = picture(scene, d, numbered(d, "paper_poster", 4), 0.8);
        if (side < 0) scene.front(print, sheet, at);
        else scene.rear(print, sheet, at);
      }
    }
  };
  return {"poster_board", width, depth, 1.7, draw};
}

Piece make_plant(const Palette& p, Dice dice) {
  const auto draw = [=, &p](SceneWriter& scene) {
    Dice d = dice;
    scene.drum(d.pick(p.covers), 0.16, {0, -0.22, 0}, {0, -0.22, 0.32});
    scene.drum(p.black, 0.15, {0, -0.22, 0.32}, {0, -0.22, 0.323});
    Finish finish;
    finish.rgb = {d.uniform(0.14, 0.24), d.uniform(0.34, 0.46), d.uniform(0.12, 0.2)};
    const std::string leaf = scene.material(finish);
    for (int i = 0; i < 9; ++i) {
      const double x = d.uniform(-0.2, 0.2), y = -0.22 + d.uniform(-0.2, 0.2), z = d.uniform(0.7, 1.2);
      scene.rod(leaf, 0.012, {0.3 * x, -0.22 + 0.3 * (y + 0.22), 0.3}, {x, y, z});
      scene.ball(leaf, d.uniform(0.03, 0.06), {x, y, z});
    }
  };
  return {"plant", 0.5, 0.45, 1.25, draw};
}

Piece make_couch(const Palette& p, Dice dice) {
  const double width = dice.uniform(1.3, 1.9), depth = 0.8;
  const auto draw = [=, &p](SceneWriter& scene) {
    const double half = width / 2;
    scene.box(p.fabric, {half - 0.121, 0.33, 0.18}, {0, -0.46, 0.24});
    scene.panel(p.fabric, {half - 0.121, 0.36, 0.06}, {0, -0.065, 0.42});
    for (const double x : {-half + 0.06, half - 0.06}) scene.box(p.fabric, {0.06, 0.39, 0.29}, {x, -0.4, 0.31});
    draw_legs(scene, p, half - 0.06, depth, 0.06);
  };
  return {"couch", width, depth, 0.8, draw};
}

Piece make_door(const Palette& p, const std::string& texture) {
  const auto draw = [=, &p](SceneWriter& scene) {
    Finish finish;
    finish.texture = texture;
    scene.front(scene.material(finish), {0.475, 1.03, 0.02}, {0, -0.02, 1.03});
    for (const double x : {-0.52, 0.52}) scene.box(p.frame, {0.045, 0.03, 1.06}, {x, -0.03, 1.06});
    scene.box(p.frame, {0.565, 0.03, 0.045}, {0, -0.03, 2.165});
  };
  return {"door", 1.13, 0.06, 2.25, draw};
}

}  // namespace groundloop::sim
