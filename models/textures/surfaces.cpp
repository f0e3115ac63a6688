#include <algorithm>
#include <cmath>

#include "models/textures/canvas.h"
#include "models/textures/textures.h"

namespace groundloop::textures {
namespace {

/// Grain of planks: noise stretched along the boards, warped into rings.
cv::Mat wood(const cv::Scalar& light, const cv::Scalar& dark, int boards, uint64_t key) {
  const cv::Size size(512, 512);
  const cv::Mat warp = noise(size, {2 * boards, 2}, 4, key), fibre = noise(size, {64, 4}, 4, key + 1);
  cv::Mat canvas(size, CV_8UC3);
  Dice dice(key);
  for (int board = 0; board < boards; ++board) {
    const double tone = dice.uniform(0.85, 1.12), rings = dice.uniform(5, 11), shift = dice.uniform(0, 9);
    const int from = size.width * board / boards, to = size.width * (board + 1) / boards;
    for (int y = 0; y < size.height; ++y) {
      for (int x = from; x < to; ++x) {
        const double ring = rings * (warp.at<float>(y, x) * 1.6 + 0.4 * (x - from) / (to - from)) + shift;
        const double t = std::pow(ring - std::floor(ring), 2.0);
        const double blend = std::clamp(0.65 * t + 0.9 * (fibre.at<float>(y, x) - 0.5) + 0.2, 0.0, 1.0);
        cv::Vec3b& pixel = canvas.at<cv::Vec3b>(y, x);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = cv::saturate_cast<uchar>(tone * (light[c] * (1 - blend) + dark[c] * blend));
        }
      }
    }
    if (boards > 1) cv::line(canvas, {from, 0}, {from, size.height - 1}, shade(dark, 0.6), 1);
  }
  return canvas;
}

void speckle(cv::Mat& canvas, int count, int smallest_px, int largest_px, double dark, double light,
             Dice& dice) {
  for (int i = 0; i < count; ++i) {
    const cv::Point at(dice.integer(0, canvas.cols - 1), dice.integer(0, canvas.rows - 1));
    const cv::Vec3b& under = canvas.at<cv::Vec3b>(at);
    const double factor = dice.chance(0.5) ? dice.uniform(dark, 1) : dice.uniform(1, light);
    const cv::Size axes(dice.integer(smallest_px, largest_px), dice.integer(smallest_px, largest_px));
    cv::ellipse(canvas, at, axes, dice.uniform(0, 180), 0, 360,
                shade({1.0 * under[0], 1.0 * under[1], 1.0 * under[2]}, factor), cv::FILLED, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat floor_tiles(uint64_t key) {
  // 4 x 4 terrazzo tiles, no two of one shade, joints of uneven width and dirt.
  const cv::Size size(1024, 1024);
  cv::Mat canvas = mottled(size, rgb(150, 146, 138), 0.12, {3, 3}, 6, key);
  Dice dice(key);
  constexpr int kTiles = 4;
  const int side = size.width / kTiles;
  for (int row = 0; row < kTiles; ++row) {
    for (int col = 0; col < kTiles; ++col) {
      cv::Mat tile = canvas(cv::Rect(col * side, row * side, side, side));
      tile.convertTo(tile, -1, dice.uniform(0.86, 1.12));
    }
  }
  speckle(canvas, 26000, 0, 1, 0.5, 1.4, dice);
  speckle(canvas, 3200, 1, 3, 0.6, 1.3, dice);
  for (int i = 0; i < 26; ++i) {  // scratches and heel marks
    const cv::Point at(dice.integer(0, 1023), dice.integer(0, 1023));
    const cv::Point to = at + cv::Point(dice.integer(-70, 70), dice.integer(-70, 70));
    cv::line(canvas, at, to, rgb(95, 92, 88), 1, cv::LINE_AA);
  }
  const cv::Mat dirt = noise(size, {24, 24}, 3, key + 7);
  for (int line = 0; line < kTiles; ++line) {
    for (int i = 0; i < size.width; ++i) {
      const int width = 1 + static_cast<int>(4 * dirt.at<float>(line * side, i));
      const double tone = 0.45 + 0.5 * dirt.at<float>(i, line * side);
      for (int w = 0; w < width; ++w) {
        canvas.at<cv::Vec3b>((line * side + w) % size.height, i) *= tone;
        canvas.at<cv::Vec3b>(i, (line * side + w) % size.width) *= tone;
      }
    }
  }
  return canvas;
}

cv::Mat ceiling_tiles(uint64_t key) {
  // 2 x 2 mineral-fibre tiles with fissures and holes at random, in a metal grid.
  const cv::Size size(1024, 1024);
  cv::Mat canvas = mottled(size, rgb(172, 172, 166), 0.06, {6, 6}, 5, key);
  Dice dice(key);
  for (int i = 0; i < 3600; ++i) {
    const cv::Point at(dice.integer(0, 1023), dice.integer(0, 1023));
    const double tone = dice.uniform(0.45, 0.8);
    const cv::Point to = at + cv::Point(dice.integer(-9, 9), dice.integer(-4, 4));
    cv::line(canvas, at, dice.chance(0.6) ? at : to, rgb(172 * tone, 172 * tone, 166 * tone),
             dice.integer(2, 4), cv::LINE_AA);
  }
  for (int edge = 0; edge < 1024; edge += 512) {
    for (const cv::Rect& bar : {cv::Rect(edge, 0, 12, 1024), cv::Rect(0, edge, 1024, 12)}) {
      fill(canvas, bar, rgb(196, 196, 192));
      frame(canvas, bar, rgb(110, 110, 108));
    }
  }
  return canvas;
}

cv::Mat plain_plaster(uint64_t key) {
  // Poor in texture on purpose: faint clouds of paint, hardly a corner.
  return mottled({1024, 1024}, rgb(176, 173, 162), 0.035, {4, 4}, 4, key);
}

cv::Mat painted_blocks(uint64_t key) {
  // Painted concrete blocks: relief in the paint, uneven joints, chips.
  const cv::Size size(1024, 1024);
  cv::Mat canvas = mottled(size, rgb(158, 163, 160), 0.20, {24, 24}, 5, key);
  Dice dice(key);
  constexpr int kRows = 8, kCols = 4;
  const int height = size.height / kRows, width = size.width / kCols;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const int x = col * width + (row % 2) * width / 2, y = row * height;
      const double tone = dice.uniform(0.9, 1.1);
      for (const int offset :
           {0, -size.width}) {  // a block that runs over the edge goes on at the other side
        const cv::Rect block = cv::Rect(x + offset, y, width, height) & cv::Rect({0, 0}, size);
        if (block.empty()) continue;
        cv::Mat area = canvas(block);
        area.convertTo(area, -1, tone);
        const int joint = dice.integer(2, 5);
        fill(canvas, cv::Rect(block.x, y, block.width, joint), rgb(118, 122, 120));
        fill(canvas, cv::Rect(x + offset, y, joint, height), rgb(112, 116, 114));
      }
    }
  }
  speckle(canvas, 2600, 1, 4, 0.6, 1.2, dice);
  return canvas;
}

cv::Mat light_wood(uint64_t key) { return wood(rgb(196, 160, 112), rgb(128, 92, 54), 3, key); }
cv::Mat dark_wood(uint64_t key) { return wood(rgb(128, 88, 58), rgb(62, 40, 26), 4, key); }

cv::Mat grey_laminate(uint64_t key) {
  cv::Mat canvas = mottled({512, 512}, rgb(150, 152, 156), 0.10, {5, 5}, 6, key);
  Dice dice(key);
  speckle(canvas, 5000, 0, 2, 0.6, 1.25, dice);
  for (int i = 0; i < 5; ++i) {  // coffee rings and stains
    const cv::Point at(dice.integer(60, 450), dice.integer(60, 450));
    cv::circle(canvas, at, dice.integer(12, 20), rgb(104, 92, 78), dice.integer(1, 2), cv::LINE_AA);
  }
  return canvas;
}

cv::Mat brushed_metal(uint64_t key) { return mottled({512, 512}, rgb(146, 150, 154), 0.16, {3, 90}, 4, key); }

cv::Mat carpet(uint64_t key) {
  cv::Mat canvas = mottled({512, 512}, rgb(92, 98, 118), 0.5, {64, 64}, 3, key);
  modulate(canvas, noise({512, 512}, {4, 4}, 4, key + 1), 0.25);
  return canvas;
}

cv::Mat fabric(uint64_t key) {
  cv::Mat canvas = mottled({256, 256}, rgb(70, 84, 122), 0.35, {48, 48}, 2, key);
  modulate(canvas, noise({256, 256}, {3, 3}, 4, key + 1), 0.3);
  return canvas;
}

cv::Mat cardboard(uint64_t key) {
  cv::Mat canvas = mottled({256, 256}, rgb(168, 128, 84), 0.12, {6, 40}, 4, key);
  Dice dice(key);
  fill(canvas, {108, 0, 40, 256}, rgb(188, 160, 112));  // tape
  fill(canvas, {24, 150, 70, 60}, rgb(214, 212, 206));  // address label
  paragraph(canvas, {28, 154, 62, 52}, 5, rgb(40, 40, 40), dice);
  write(canvas, "FRAGILE", {156, 70}, 14, rgb(140, 30, 24), 2);
  write(canvas, word(dice), {160, 220}, 12, rgb(50, 40, 30), 2);
  frame(canvas, {0, 0, 256, 256}, rgb(110, 82, 52), 3);
  return canvas;
}

cv::Mat painted_metal(uint64_t key) {
  cv::Mat canvas = mottled({256, 256}, rgb(116, 124, 132), 0.12, {4, 4}, 5, key);
  Dice dice(key);
  speckle(canvas, 220, 0, 2, 0.6, 1.3, dice);
  return canvas;
}

}  // namespace groundloop::textures
