#include <algorithm>
#include <cmath>

#include "models/textures/canvas.h"
#include "models/textures/textures.h"

namespace groundloop::textures {
namespace {

void knob(cv::Mat& canvas, cv::Point at, int radius, Dice& dice) {
  cv::circle(canvas, at, radius + 3, rgb(180, 182, 184), 1, cv::LINE_AA);
  cv::circle(canvas, at, radius, rgb(38, 38, 42), cv::FILLED, cv::LINE_AA);
  const double angle = dice.uniform(0, 6.28);
  cv::line(
      canvas, at,
      at + cv::Point(static_cast<int>(radius * std::cos(angle)), static_cast<int>(radius * std::sin(angle))),
      rgb(220, 220, 215), 2, cv::LINE_AA);
}

void display(cv::Mat& canvas, const cv::Rect& box, Dice& dice) {
  fill(canvas, box, rgb(18, 30, 22));
  frame(canvas, box, rgb(160, 160, 160), 2);
  std::string digits;
  for (int i = 0; i < 5; ++i) digits += static_cast<char>('0' + dice.integer(0, 9));
  digits.insert(static_cast<size_t>(dice.integer(1, 3)), ".");
  write(canvas, digits, {box.x + 6, box.y + box.height * 3 / 4}, box.height * 0.5, rgb(110, 226, 130), 2);
}

/// One face of trace, graticule and glow.
void scope_face(cv::Mat& canvas, const cv::Rect& box, Dice& dice) {
  fill(canvas, box, rgb(20, 46, 42));
  for (int i = 1; i < 10; ++i)
    cv::line(canvas, {box.x + box.width * i / 10, box.y}, {box.x + box.width * i / 10, box.br().y},
             rgb(52, 92, 84), 1);
  for (int i = 1; i < 8; ++i)
    cv::line(canvas, {box.x, box.y + box.height * i / 8}, {box.br().x, box.y + box.height * i / 8},
             rgb(52, 92, 84), 1);
  for (int trace = 0; trace < 2; ++trace) {
    const double rate = dice.uniform(6, 26), centre = box.y + box.height * (trace == 0 ? 0.35 : 0.68);
    cv::Point last;
    for (int i = 0; i <= 100; ++i) {
      const double wave = std::sin(rate * i / 100.0), value = trace == 0 ? wave : (wave > 0 ? 1 : -1);
      const cv::Point at(box.x + box.width * i / 100, static_cast<int>(centre + 0.14 * box.height * value));
      if (i > 0)
        cv::line(canvas, last, at, trace == 0 ? rgb(240, 232, 110) : rgb(110, 220, 240), 2, cv::LINE_AA);
      last = at;
    }
  }
  frame(canvas, box, rgb(26, 26, 28), 6);
}

}  // namespace

cv::Mat rack_panels(uint64_t key) {
  // A 19-inch rack from top to bottom: modules of 1 to 4 height units, each of its own kind.
  cv::Mat canvas(1024, 512, CV_8UC3, rgb(40, 42, 46));
  Dice dice(key);
  constexpr int kUnit = 36;
  for (int y = 12; y < 1000;) {
    const int height = std::min(kUnit * dice.integer(1, 4), 1012 - y);
    const cv::Rect panel(34, y, 444, height - 4);
    const double tone = dice.uniform(70, 190);
    fill(canvas, panel, rgb(tone, tone * 1.01, tone * 1.04));
    frame(canvas, panel, rgb(20, 20, 22), 2);
    for (const int x : {16, 496})
      cv::circle(canvas, {x, y + height / 2}, 5, rgb(150, 150, 150), cv::FILLED, cv::LINE_AA);
    write(canvas, word(dice) + " " + std::to_string(dice.integer(100, 9999)), {44, y + 16}, 9,
          tone > 120 ? rgb(30, 30, 30) : rgb(210, 210, 210));
    const int middle = y + height / 2 + 6;
    switch (dice.integer(0, 4)) {
      case 0:  // meters and knobs
        display(canvas, {60, y + height / 3, 120, std::min(44, height / 2)}, dice);
        for (int x = 220; x < 460; x += dice.integer(36, 58))
          knob(canvas, {x, middle}, std::min(15, height / 4), dice);
        break;
      case 1:  // ventilation slots
        for (int x = 60; x < 450; x += dice.integer(14, 22))
          fill(canvas, {x, y + height / 3, 8, height / 2}, rgb(26, 26, 28));
        break;
      case 2:  // sockets and lamps
        for (int x = 70; x < 450; x += dice.integer(24, 44)) {
          cv::circle(canvas, {x, middle}, 8, rgb(28, 28, 30), cv::FILLED, cv::LINE_AA);
          if (dice.chance(0.6))
            cv::circle(canvas, {x, middle - 16}, 4, dice.chance(0.5) ? rgb(70, 230, 90) : rgb(235, 80, 60),
                       cv::FILLED, cv::LINE_AA);
        }
        break;
      case 3:  // drives
        for (int x = 60; x + 60 < 470; x += 68) {
          fill(canvas, {x, y + height / 4 + 6, 60, height / 2}, rgb(52, 54, 58));
          frame(canvas, {x, y + height / 4 + 6, 60, height / 2}, rgb(120, 124, 130));
          cv::circle(canvas, {x + 50, y + height / 4 + 14}, 3, rgb(90, 220, 120), cv::FILLED, cv::LINE_AA);
        }
        break;
      default:  // a small scope with keys
        scope_face(canvas, {60, y + 22, 140, std::max(20, height - 40)}, dice);
        for (int i = 0; i < 14; ++i) {
          fill(canvas, {230 + (i % 7) * 32, y + height / 3 + (i / 7) * 24, 24, 14},
               rgb(dice.uniform(60, 210), dice.uniform(60, 210), dice.uniform(60, 200)));
        }
    }
    y += height;
  }
  return canvas;
}

cv::Mat oscilloscope(uint64_t key) {
  cv::Mat canvas = mottled({512, 320}, rgb(176, 178, 172), 0.05, {4, 3}, 3, key);
  Dice dice(key);
  scope_face(canvas, {20, 40, 270, 216}, dice);
  write(canvas, "TEKLAB  " + std::to_string(dice.integer(200, 999)) + "B", {22, 28}, 13, rgb(40, 40, 60), 2);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 4; ++col) {
      const cv::Point at(326 + col * 48, 66 + row * 66);
      if (dice.chance(0.7))
        knob(canvas, at, dice.integer(9, 17), dice);
      else
        fill(canvas, {at.x - 14, at.y - 8, 28, 16}, rgb(80, 120, 170));
      write(canvas, word(dice), {at.x - 18, at.y + 32}, 6, rgb(40, 40, 40));
    }
  }
  for (int x = 60; x < 480; x += 84) {  // BNC sockets
    cv::circle(canvas, {x, 288}, 15, rgb(150, 152, 156), cv::FILLED, cv::LINE_AA);
    cv::circle(canvas, {x, 288}, 8, rgb(40, 40, 44), cv::FILLED, cv::LINE_AA);
  }
  frame(canvas, {0, 0, 512, 320}, rgb(84, 86, 90), 8);
  return canvas;
}

cv::Mat power_supply(uint64_t key) {
  cv::Mat canvas = mottled({512, 256}, rgb(120, 128, 138), 0.05, {4, 3}, 3, key);
  Dice dice(key);
  display(canvas, {24, 24, 140, 56}, dice);
  display(canvas, {190, 24, 140, 56}, dice);
  for (int x = 60; x < 340; x += 64) knob(canvas, {x, 130}, 20, dice);
  const cv::Scalar posts[] = {rgb(190, 40, 36), rgb(24, 24, 26), rgb(50, 130, 60)};
  for (int i = 0; i < 6; ++i)
    cv::circle(canvas, {70 + i * 62, 210}, 13, posts[i % 3], cv::FILLED, cv::LINE_AA);
  for (int i = 0; i < 7; ++i) fill(canvas, {370 + (i % 3) * 42, 40 + (i / 3) * 56, 30, 38}, rgb(60, 64, 70));
  write(canvas, "DC POWER 30V 5A", {210, 250}, 11, rgb(225, 225, 220));
  frame(canvas, {0, 0, 512, 256}, rgb(50, 52, 58), 6);
  return canvas;
}

cv::Mat keyboard(uint64_t key) {
  cv::Mat canvas(192, 512, CV_8UC3, rgb(52, 52, 56));
  Dice dice(key);
  for (int row = 0; row < 5; ++row) {
    for (int x = 12 + row * 5; x < 490;) {
      const int width = row == 4 && x > 110 && x < 200 ? 180 : 24 + (dice.chance(0.15) ? 14 : 0);
      const double tone = dice.uniform(150, 200);
      fill(canvas, {x, 12 + row * 35, std::min(width, 500 - x), 28}, rgb(tone, tone, tone * 0.97));
      write(canvas, std::string(1, static_cast<char>('A' + dice.integer(0, 25))), {x + 5, 30 + row * 35}, 8,
            rgb(40, 40, 44));
      x += width + 5;
    }
  }
  return canvas;
}

cv::Mat cabinet_doors(uint64_t key) {
  // Two sheet-metal doors with louvres, handles and labels.
  cv::Mat canvas = mottled({512, 1024}, rgb(146, 152, 148), 0.09, {3, 5}, 5, key);
  Dice dice(key);
  for (const int x : {0, 256}) {
    frame(canvas, {x + 8, 10, 240, 1004}, rgb(74, 78, 78), 4);
    int y = 60;
    for (int i = 0; i < 5; ++i, y += dice.integer(20, 30))
      fill(canvas, {x + 60, y, dice.integer(110, 140), 7}, rgb(60, 62, 62));
    const cv::Rect label(x + 56, dice.integer(230, 320), 130, 74);
    fill(canvas, label, rgb(212, 210, 200));
    write(canvas, word(dice), label.tl() + cv::Point(10, 30), 15, rgb(30, 30, 36), 2);
    write(canvas, word(dice) + " " + std::to_string(dice.integer(1, 40)), label.tl() + cv::Point(10, 60), 13,
          rgb(30, 30, 36));
    fill(canvas, {x == 0 ? 214 : 280, 470, 18, 100}, rgb(44, 46, 50));
    for (int i = 0; i < 7; ++i) {  // stickers, dents
      const cv::Scalar colour = rgb(dice.uniform(40, 210), dice.uniform(40, 210), dice.uniform(40, 210));
      fill(canvas,
           {x + dice.integer(24, 190), dice.integer(360, 960), dice.integer(14, 46), dice.integer(10, 36)},
           colour);
    }
  }
  return canvas;
}

cv::Mat drawers(uint64_t key) {
  cv::Mat canvas = mottled({512, 512}, rgb(138, 136, 132), 0.09, {4, 4}, 5, key);
  Dice dice(key);
  for (int row = 0, y = 6; row < 4; ++row) {
    const int height = row == 3 ? 500 - y : dice.integer(84, 136);
    frame(canvas, {8, y, 496, height - 6}, rgb(62, 62, 62), 4);
    fill(canvas, {190 + dice.integer(-20, 20), y + height / 2, 120, 14}, rgb(52, 52, 56));
    fill(canvas, {40, y + 24, 86, 36}, rgb(205, 204, 196));
    write(canvas, word(dice), {44, y + 48}, 12, rgb(30, 30, 34), 1);
    if (dice.chance(0.6))
      fill(canvas, {dice.integer(340, 430), y + 20, 44, 40},
           rgb(dice.uniform(60, 220), dice.uniform(60, 200), 60));
    y += height;
  }
  return canvas;
}

cv::Mat circuit_board(uint64_t key) {
  cv::Mat canvas = mottled({256, 256}, rgb(32, 92, 56), 0.12, {5, 5}, 4, key);
  Dice dice(key);
  for (int i = 0; i < 70; ++i) {
    cv::Point at(dice.integer(0, 255), dice.integer(0, 255));
    const cv::Point turn = at + cv::Point(dice.integer(-50, 50), 0),
                    to = turn + cv::Point(0, dice.integer(-50, 50));
    cv::line(canvas, at, turn, rgb(96, 160, 104), 1);
    cv::line(canvas, turn, to, rgb(96, 160, 104), 1);
    cv::circle(canvas, to, 2, rgb(206, 196, 130), cv::FILLED, cv::LINE_AA);
  }
  for (int i = 0; i < 14; ++i) {
    const cv::Rect chip(dice.integer(4, 200), dice.integer(4, 210), dice.integer(14, 52),
                        dice.integer(12, 34));
    fill(canvas, chip, rgb(28, 28, 30));
    for (int x = chip.x + 2; x < chip.br().x; x += 5) {
      fill(canvas, {x, chip.y - 3, 2, 3}, rgb(190, 190, 190));
      fill(canvas, {x, chip.br().y, 2, 3}, rgb(190, 190, 190));
    }
  }
  return canvas;
}

cv::Mat door(uint64_t key) {
  cv::Mat canvas = dark_wood(key);
  cv::resize(canvas, canvas, {512, 1024}, 0, 0, cv::INTER_LINEAR);
  canvas.convertTo(canvas, -1, 1.25, 8);
  Dice dice(key);
  frame(canvas, {10, 10, 492, 1004}, rgb(52, 36, 26), 8);
  frame(canvas, {84, 560, 344, 380}, rgb(60, 42, 30), 6);
  fill(canvas, {176, 90, 160, 330}, rgb(120, 142, 150));  // glass
  cv::line(canvas, {176, 330}, {336, 130}, rgb(176, 190, 196), 18, cv::LINE_AA);
  frame(canvas, {176, 90, 160, 330}, rgb(40, 30, 24), 8);
  fill(canvas, {420, 520, 60, 16}, rgb(196, 190, 170));
  fill(canvas, {420, 490, 22, 84}, rgb(150, 146, 130));
  fill(canvas, {40, 470, 110, 66}, rgb(210, 208, 200));
  write(canvas, "LAB " + std::to_string(dice.integer(1, 40)), {48, 500}, 18, rgb(30, 30, 34), 2);
  write(canvas, word(dice), {48, 526}, 12, rgb(30, 30, 34));
  fill(canvas, {12, 940, 488, 66}, rgb(150, 150, 146));  // kick plate
  return canvas;
}

cv::Mat breadboard_plate(uint64_t key) {
  // The top of an optical table, with the clutter of an experiment.
  cv::Mat canvas = mottled({512, 512}, rgb(96, 98, 102), 0.10, {4, 4}, 5, key);
  Dice dice(key);
  for (int y = 16; y < 512; y += 32) {
    for (int x = 16; x < 512; x += 32) {
      cv::circle(canvas, {x, y}, 4, rgb(28, 28, 30), cv::FILLED, cv::LINE_AA);
    }
  }
  for (int i = 0; i < 9; ++i) {
    const cv::Rect base(dice.integer(0, 430), dice.integer(0, 430), dice.integer(30, 90),
                        dice.integer(30, 80));
    fill(canvas, base, rgb(34, 34, 36));
    frame(canvas, base, rgb(140, 140, 140), 2);
    cv::circle(canvas, (base.tl() + base.br()) / 2, 12, rgb(186, 170, 120), cv::FILLED, cv::LINE_AA);
  }
  return canvas;
}

cv::Mat switchboard(uint64_t key) {
  // Mains distribution: breakers, sockets, warning sign.
  cv::Mat canvas = mottled({256, 512}, rgb(188, 188, 180), 0.05, {3, 4}, 4, key);
  Dice dice(key);
  for (int row = 0; row < 4; ++row) {
    for (int x = 24; x < 224; x += dice.integer(20, 27)) {
      fill(canvas, {x, 40 + row * 84, 16, 48}, rgb(56, 58, 62));
      fill(canvas, {x + 4, 52 + row * 84 + (dice.chance(0.5) ? 0 : 14), 8, 12}, rgb(200, 60, 40));
    }
    write(canvas, word(dice) + " " + std::to_string(row + 1), {28, 34 + row * 84}, 9, rgb(40, 40, 44));
  }
  fill(canvas, {70, 390, 110, 96}, rgb(226, 190, 40));
  frame(canvas, {70, 390, 110, 96}, rgb(24, 24, 24), 5);
  cv::line(canvas, {132, 402}, {112, 444}, rgb(20, 20, 20), 7, cv::LINE_AA);
  cv::line(canvas, {112, 444}, {138, 438}, rgb(20, 20, 20), 7, cv::LINE_AA);
  cv::line(canvas, {138, 438}, {120, 476}, rgb(20, 20, 20), 7, cv::LINE_AA);
  frame(canvas, {0, 0, 256, 512}, rgb(100, 100, 96), 6);
  return canvas;
}

}  // namespace groundloop::textures
