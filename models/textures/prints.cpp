#include <algorithm>
#include <cmath>

#include "models/textures/canvas.h"
#include "models/textures/textures.h"

namespace groundloop::textures {
namespace {

/// Printer's colours: any hue, little saturation.
cv::Scalar any_colour(Dice& dice, double low = 30, double high = 210) {
  const double grey = dice.uniform(low, high);
  const auto channel = [&](double warmth) { return 0.62 * grey * warmth + 0.38 * dice.uniform(low, high); };
  const double red = channel(1.06), green = channel(1.0), blue = channel(0.92);
  return rgb(red, green, blue);
}

std::string title(Dice& dice, int words) {
  std::string text;
  for (int i = 0; i < words; ++i) text += word(dice) + " ";
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(text[0]));
  return text;
}

/// A hand-drawn line: short strokes that do not quite hit their ends.
void scribble(cv::Mat& canvas, cv::Point from, cv::Point to, const cv::Scalar& colour, Dice& dice) {
  cv::Point last = from;
  for (int i = 1; i <= 6; ++i) {
    const cv::Point at(from.x + (to.x - from.x) * i / 6 + dice.integer(-2, 2),
                       from.y + (to.y - from.y) * i / 6 + dice.integer(-2, 2));
    cv::line(canvas, last, at, colour, 2, cv::LINE_AA);
    last = at;
  }
}

/// Blobs of colour over a gradient: reads as a photograph from a distance.
void photograph(cv::Mat& canvas, const cv::Rect& box, Dice& dice) {
  cv::Mat area = canvas(box);
  const cv::Scalar sky = any_colour(dice, 110, 220), ground = any_colour(dice, 40, 150);
  for (int y = 0; y < area.rows; ++y) {
    const double t = static_cast<double>(y) / area.rows;
    cv::line(area, {0, y}, {area.cols, y}, sky * (1 - t) + ground * t, 1);
  }
  for (int i = 0; i < 60; ++i) {
    const cv::Point at(dice.integer(0, area.cols), dice.integer(area.rows / 3, area.rows));
    const cv::Size axes(dice.integer(4, area.cols / 6), dice.integer(3, area.rows / 8));
    cv::ellipse(area, at, axes, dice.uniform(0, 180), 0, 360, any_colour(dice), cv::FILLED, cv::LINE_AA);
  }
  modulate(area, noise(area.size(), {8, 8}, 4, static_cast<uint64_t>(dice.integer(0, 1 << 20))), 0.3);
}

void row_of_spines(cv::Mat& canvas, double narrow_px, double wide_px, bool binders, Dice& dice) {
  for (int x = 0; x < canvas.cols;) {
    const int width = static_cast<int>(dice.uniform(narrow_px, wide_px));
    const int top = binders ? 6 : static_cast<int>(canvas.rows * dice.uniform(0, 0.28));
    const cv::Rect spine(x, top, width, canvas.rows - top);
    const cv::Scalar cover = any_colour(dice, 45, 205);
    fill(canvas, spine, cover);
    cv::line(canvas, {x + 1, top}, {x + 1, canvas.rows}, shade(cover, 1.35), 2);
    cv::line(canvas, {x + width - 1, top}, {x + width - 1, canvas.rows}, shade(cover, 0.45), 2);
    const cv::Scalar ink = cover[1] > 110 ? rgb(28, 26, 30) : rgb(224, 220, 205);
    if (binders) {
      fill(canvas, {x + width / 6, top + canvas.rows / 5, 2 * width / 3, canvas.rows / 3},
           rgb(215, 213, 205));
      write(canvas, std::to_string(dice.integer(1, 99)), {x + width / 4, top + canvas.rows * 2 / 5},
            width / 4.0, rgb(25, 25, 25), 2);
      cv::circle(canvas, {x + width / 2, canvas.rows * 4 / 5}, width / 5, shade(cover, 0.3), 3, cv::LINE_AA);
    } else {
      // The title runs along the spine: written flat, turned by a quarter.
      cv::Mat label(width, spine.height, CV_8UC3, cover);
      write(label, title(dice, 3), {spine.height / 8, width * 2 / 3}, std::min(14.0, 0.4 * width), ink);
      cv::rotate(label, label, cv::ROTATE_90_CLOCKWISE);
      cv::Mat inner = canvas(spine & cv::Rect({0, 0}, canvas.size()));
      label(cv::Rect({0, 0}, inner.size())).copyTo(inner);
      const int band = dice.integer(8, 40);
      fill(canvas, {x, top + band, width, dice.integer(3, 14)}, any_colour(dice));
      cv::line(canvas, {x, top}, {x, canvas.rows}, shade(cover, 0.5), 2);
    }
    x += width;
    if (!binders && dice.chance(0.08)) x += dice.integer(6, 24);
  }
}

}  // namespace

cv::Mat paper_poster(uint64_t key) {
  // A conference poster: banner, two columns of text, plots.
  cv::Mat canvas(768, 512, CV_8UC3, rgb(206, 205, 200));
  Dice dice(key);
  const cv::Scalar banner = any_colour(dice, 30, 130), ink = rgb(32, 32, 36);
  fill(canvas, {0, 0, 512, 110}, banner);
  write(canvas, title(dice, 3), {24, 48}, 24, rgb(225, 225, 220), 3);
  write(canvas, title(dice, 5), {24, 88}, 14, rgb(210, 210, 205), 2);
  for (int column = 0; column < 2; ++column) {
    const int x = 20 + column * 246;
    for (int y = 126; y < 730;) {
      if (dice.chance(0.45)) {
        plot(canvas, {x, y, 226, 150}, rgb(226, 226, 222), ink, dice);
        frame(canvas, {x, y, 226, 150}, rgb(90, 90, 90), 1);
        y += 164;
      } else {
        write(canvas, title(dice, 2), {x, y + 18}, 14, banner, 2);
        paragraph(canvas, {x, y + 26, 226, 96}, 8, ink, dice);
        y += 132;
      }
    }
  }
  frame(canvas, {0, 0, 512, 768}, rgb(60, 60, 64), 4);
  return canvas;
}

cv::Mat photo_poster(uint64_t key) {
  cv::Mat canvas(512, 512, CV_8UC3, rgb(200, 198, 190));
  Dice dice(key);
  photograph(canvas, {24, 24, 464, 360}, dice);
  write(canvas, title(dice, 2), {30, 432}, 26, rgb(30, 30, 34), 3);
  paragraph(canvas, {30, 450, 452, 44}, 9, rgb(60, 60, 64), dice);
  frame(canvas, {0, 0, 512, 512}, rgb(40, 40, 44), 6);
  return canvas;
}

cv::Mat table_poster(uint64_t key) {
  // Laid out like the table of elements.
  cv::Mat canvas(512, 1024, CV_8UC3, rgb(196, 198, 196));
  Dice dice(key);
  write(canvas, "Periodic table of the elements", {170, 44}, 22, rgb(30, 30, 30), 2);
  for (int row = 0; row < 9; ++row) {
    const int y = 64 + row * 48 + (row > 6 ? 14 : 0);
    for (int col = 0; col < 18; ++col) {
      const bool there = row == 0   ? col == 0 || col == 17
                         : row < 3  ? col < 2 || col > 11
                         : row <= 6 ? true
                                    : col > 1 && col < 17;
      if (!there) continue;
      const cv::Rect cell(22 + col * 54, y, 52, 46);
      fill(canvas, cell, any_colour(dice, 100, 215));
      frame(canvas, cell, rgb(50, 50, 50));
      const std::string symbol = {static_cast<char>('A' + dice.integer(0, 25)),
                                  static_cast<char>('a' + dice.integer(0, 25))};
      write(canvas, symbol, cell.tl() + cv::Point(8, 34), 17, rgb(25, 25, 25), 2);
      write(canvas, std::to_string(dice.integer(1, 118)), cell.tl() + cv::Point(4, 12), 7, rgb(40, 40, 40));
    }
  }
  return canvas;
}

cv::Mat map_poster(uint64_t key) {
  // Coast lines from noise, with a graticule.
  const cv::Size size(1024, 512);
  const cv::Mat height = noise(size, {5, 3}, 6, key);
  cv::Mat canvas(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float h = height.at<float>(y, x);
      const cv::Scalar colour = h < 0.47F    ? rgb(96, 134, 168) * (0.7 + 0.6 * h)
                                : h < 0.485F ? rgb(60, 60, 50)
                                : h < 0.56F  ? rgb(128, 158, 100) * (0.6 + 0.7 * h)
                                             : rgb(188, 160, 118) * (0.4 + 1.0 * h);
      for (int c = 0; c < 3; ++c) canvas.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<uchar>(colour[c]);
    }
  }
  Dice dice(key);
  for (int x = 40; x < size.width; x += 113)
    cv::line(canvas, {x, 0}, {x, size.height}, rgb(80, 90, 110), 1, cv::LINE_AA);
  for (int y = 30; y < size.height; y += 97)
    cv::line(canvas, {0, y}, {size.width, y}, rgb(80, 90, 110), 1, cv::LINE_AA);
  for (int i = 0; i < 34; ++i) {
    const cv::Point at(dice.integer(20, 960), dice.integer(20, 490));
    cv::circle(canvas, at, 3, rgb(150, 30, 30), cv::FILLED, cv::LINE_AA);
    write(canvas, title(dice, 1), at + cv::Point(6, 4), 9, rgb(25, 25, 25));
  }
  frame(canvas, {0, 0, size.width, size.height}, rgb(40, 40, 40), 8);
  return canvas;
}

cv::Mat book_row(uint64_t key) {
  cv::Mat canvas(256, 1024, CV_8UC3, rgb(34, 28, 24));
  Dice dice(key);
  row_of_spines(canvas, 18, 58, false, dice);
  return canvas;
}

cv::Mat binder_row(uint64_t key) {
  cv::Mat canvas(256, 1024, CV_8UC3, rgb(30, 30, 32));
  Dice dice(key);
  row_of_spines(canvas, 52, 86, true, dice);
  return canvas;
}

cv::Mat whiteboard(uint64_t key) {
  cv::Mat canvas = mottled({1024, 512}, rgb(205, 207, 208), 0.05, {4, 3}, 4, key);
  Dice dice(key);
  const cv::Scalar inks[] = {rgb(24, 40, 120), rgb(20, 20, 24), rgb(160, 24, 28), rgb(20, 110, 50)};
  const char* formulas[] = {
      "z = f b / d",     "dx/dt = A x + B u", "E{ e e^T } = R",     "min  sum log(1 + r^2/2s^2)",
      "p = K (R X + t)", "J^T J + m I",       "s(Z) = Z^2 / f b s", "calibrate the head!",
      "u' - u = d",      "F(x) > 0 ?",        "det = 0.0193",       "L = 14 x 9 m"};
  int row = 0;
  for (const char* formula : formulas) {
    const cv::Point at(34 + (row % 3) * 330 + dice.integer(-10, 30),
                       66 + (row / 3) * 120 + dice.integer(-16, 16));
    write(canvas, formula, at, dice.uniform(17, 27), inks[dice.integer(0, 3)], 2);
    if (dice.chance(0.5))
      scribble(canvas, at + cv::Point(0, 12), at + cv::Point(180, 14), inks[dice.integer(0, 3)], dice);
    ++row;
  }
  for (int i = 0; i < 8; ++i) {  // boxes, arrows, circles
    const cv::Point at(dice.integer(40, 900), dice.integer(60, 440));
    const int w = dice.integer(40, 130), h = dice.integer(24, 70);
    const cv::Scalar& ink = inks[dice.integer(0, 3)];
    scribble(canvas, at, at + cv::Point(w, 0), ink, dice);
    scribble(canvas, at + cv::Point(w, 0), at + cv::Point(w, h), ink, dice);
    scribble(canvas, at + cv::Point(w, h), at + cv::Point(0, h), ink, dice);
    scribble(canvas, at + cv::Point(0, h), at, ink, dice);
    cv::arrowedLine(canvas, at + cv::Point(w, h / 2),
                    at + cv::Point(w + dice.integer(30, 90), h / 2 + dice.integer(-30, 30)), ink, 2,
                    cv::LINE_AA);
  }
  for (int i = 0; i < 4; ++i) {  // badly wiped
    const cv::Rect smear(dice.integer(0, 800), dice.integer(0, 420), dice.integer(90, 200),
                         dice.integer(30, 80));
    cv::Mat area = canvas(smear);
    cv::GaussianBlur(area, area, {0, 0}, 5);
  }
  frame(canvas, {0, 0, 1024, 512}, rgb(120, 122, 126), 14);
  return canvas;
}

cv::Mat cork_board(uint64_t key) {
  cv::Mat canvas = mottled({1024, 512}, rgb(160, 116, 72), 0.35, {120, 60}, 3, key);
  Dice dice(key);
  for (int i = 0; i < 22; ++i) {
    cv::Mat sheet(dice.integer(80, 170), dice.integer(70, 190), CV_8UC3,
                  dice.chance(0.6) ? rgb(212, 211, 204) : any_colour(dice, 140, 215));
    if (dice.chance(0.3)) {
      photograph(sheet, {6, 6, sheet.cols - 12, sheet.rows - 12}, dice);
    } else if (dice.chance(0.3)) {
      plot(sheet, {4, 4, sheet.cols - 8, sheet.rows - 8}, rgb(220, 220, 216), rgb(30, 30, 30), dice);
    } else {
      write(sheet, title(dice, 1), {8, 24}, 14, rgb(30, 30, 60), 2);
      paragraph(sheet, {8, 32, sheet.cols - 16, sheet.rows - 40}, 7, rgb(40, 40, 44), dice);
    }
    frame(sheet, {0, 0, sheet.cols, sheet.rows}, rgb(110, 104, 96));
    const cv::Rect at(dice.integer(16, 1008 - sheet.cols), dice.integer(16, 496 - sheet.rows), sheet.cols,
                      sheet.rows);
    sheet.copyTo(canvas(at));
    cv::circle(canvas, {at.x + at.width / 2, at.y + 7}, 6, any_colour(dice, 20, 200), cv::FILLED,
               cv::LINE_AA);
  }
  frame(canvas, {0, 0, 1024, 512}, rgb(96, 66, 38), 20);
  return canvas;
}

cv::Mat code_screen(uint64_t key) {
  cv::Mat canvas(320, 512, CV_8UC3, rgb(24, 28, 36));
  Dice dice(key);
  fill(canvas, {0, 0, 512, 20}, rgb(92, 98, 110));
  write(canvas, word(dice) + ".cpp", {10, 15}, 9, rgb(230, 230, 230));
  fill(canvas, {0, 20, 90, 300}, rgb(44, 50, 60));
  for (int y = 38; y < 312; y += 15) {
    write(canvas, word(dice), {8, y}, 7, rgb(150, 160, 170));
    int x = 100 + 14 * dice.integer(0, 4);
    while (x < 470 && !dice.chance(0.18)) {
      const std::string token = word(dice);
      write(canvas, token, {x, y}, 8, any_colour(dice, 120, 240));
      x += 9 * static_cast<int>(token.size()) + 8;
    }
  }
  return canvas;
}

cv::Mat plot_screen(uint64_t key) {
  cv::Mat canvas = mottled({512, 320}, rgb(70, 104, 140), 0.3, {3, 2}, 4, key);
  Dice dice(key);
  const cv::Rect windows[] = {{14, 14, 290, 200}, {270, 110, 226, 180}, {40, 190, 200, 110}};
  for (const cv::Rect& window : windows) {
    fill(canvas, window, rgb(205, 206, 208));
    fill(canvas, {window.x, window.y, window.width, 16}, any_colour(dice, 50, 130));
    write(canvas, title(dice, 2), window.tl() + cv::Point(6, 12), 8, rgb(235, 235, 235));
    plot(canvas, {window.x + 4, window.y + 20, window.width - 8, window.height - 26}, rgb(224, 226, 226),
         rgb(30, 30, 30), dice);
    frame(canvas, window, rgb(30, 30, 34));
  }
  fill(canvas, {0, 302, 512, 18}, rgb(40, 44, 52));
  return canvas;
}

cv::Mat window_view(uint64_t key) {
  // A courtyard: sky, the facade opposite, trees, behind a frame with cross bars.
  const cv::Size size(1024, 512);
  cv::Mat canvas = mottled(size, rgb(176, 196, 214), 0.14, {4, 3}, 5, key);
  Dice dice(key);
  fill(canvas, {90, 150, 560, 362}, rgb(150, 122, 100));
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 7; ++col) {
      const cv::Rect pane(112 + col * 78 + dice.integer(-3, 3), 172 + row * 86, 44, 58);
      fill(canvas, pane, any_colour(dice, 40, 120));
      frame(canvas, pane, rgb(205, 200, 190), 4);
      cv::line(canvas, {pane.x + 22, pane.y}, {pane.x + 22, pane.y + 58}, rgb(200, 196, 188), 2);
    }
  }
  for (int i = 0; i < 900; ++i) {  // leaves
    const double angle = dice.uniform(0, 6.28), radius = 150 * std::sqrt(dice.uniform());
    const cv::Point at(810 + static_cast<int>(radius * std::cos(angle)),
                       270 + static_cast<int>(0.9 * radius * std::sin(angle)));
    cv::circle(canvas, at, dice.integer(4, 12),
               rgb(dice.uniform(40, 96), dice.uniform(80, 150), dice.uniform(36, 70)), cv::FILLED,
               cv::LINE_AA);
  }
  fill(canvas, {800, 380, 24, 132}, rgb(74, 56, 40));
  for (const int x : {0, 332, 668, 1000}) fill(canvas, {x, 0, 24, 512}, rgb(206, 206, 202));
  for (const int y : {0, 128, 488}) fill(canvas, {0, y, 1024, 24}, rgb(206, 206, 202));
  for (const int x : {24, 356, 692}) frame(canvas, {x, 24, x == 356 ? 312 : 308, 464}, rgb(96, 96, 96), 2);
  return canvas;
}

cv::Mat papers(uint64_t key) {
  // Sheets strewn over a desk pad.
  cv::Mat canvas = mottled({512, 512}, rgb(72, 84, 78), 0.15, {6, 6}, 4, key);
  Dice dice(key);
  for (int i = 0; i < 5; ++i) {
    cv::Mat sheet(230, 170, CV_8UC3, rgb(210, 209, 203));
    write(sheet, title(dice, 2), {12, 28}, 13, rgb(30, 30, 40), 2);
    paragraph(sheet, {12, 38, 146, 90}, 7, rgb(40, 40, 46), dice);
    plot(sheet, {14, 134, 140, 86}, rgb(222, 222, 218), rgb(30, 30, 30), dice);
    frame(sheet, {0, 0, 170, 230}, rgb(120, 118, 112), 2);
    cv::Mat turn = cv::getRotationMatrix2D({85, 115}, dice.uniform(-35, 35), 1);
    turn.at<double>(0, 2) += dice.uniform(20, 320);
    turn.at<double>(1, 2) += dice.uniform(10, 270);
    cv::warpAffine(sheet, canvas, turn, canvas.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  }
  return canvas;
}

}  // namespace groundloop::textures
