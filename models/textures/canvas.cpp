#include "models/textures/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace groundloop::textures {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
uint64_t mix(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

double Dice::uniform(double low, double high) {
  const uint64_t bits = mix(mix(key_ + 0x9e3779b97f4a7c15ULL) + 0x9e3779b97f4a7c15ULL * ++counter_);
  return low + (high - low) * static_cast<double>(bits >> 11) * 0x1p-53;
}

int Dice::integer(int low, int high) {
  return std::min(high, low + static_cast<int>(uniform() * (high - low + 1)));
}

cv::Scalar rgb(double red, double green, double blue) { return {blue, green, red}; }

cv::Scalar shade(const cv::Scalar& colour, double factor) {
  return {std::min(255.0, colour[0] * factor), std::min(255.0, colour[1] * factor),
          std::min(255.0, colour[2] * factor)};
}

cv::Mat noise(cv::Size size, cv::Size cells, int octaves, uint64_t key) {
  cv::Mat sum(size, CV_32F, cv::Scalar(0));
  float weight = 0.5F, total = 0;
  for (int octave = 0; octave < octaves; ++octave, weight *= 0.5F, cells *= 2) {
    Dice dice(key * 31 + octave);
    std::vector<float> lattice(static_cast<size_t>(cells.width) * cells.height);
    for (float& value : lattice) value = static_cast<float>(dice.uniform());
    for (int y = 0; y < size.height; ++y) {
      const float v = static_cast<float>(y) * cells.height / size.height;
      const int row = static_cast<int>(v);
      const float t = v - row, ease_t = t * t * (3 - 2 * t);
      const float* above = &lattice[static_cast<size_t>(row) * cells.width];
      const float* below = &lattice[static_cast<size_t>((row + 1) % cells.height) * cells.width];
      float* out = sum.ptr<float>(y);
      for (int x = 0; x < size.width; ++x) {
        const float u = static_cast<float>(x) * cells.width / size.width;
        const int col = static_cast<int>(u), next = (col + 1) % cells.width;
        const float s = u - col, ease_s = s * s * (3 - 2 * s);
        const float top = above[col] + (above[next] - above[col]) * ease_s;
        const float bottom = below[col] + (below[next] - below[col]) * ease_s;
        out[x] += weight * (top + (bottom - top) * ease_t);
      }
    }
    total += weight;
  }
  sum /= total;
  return sum;
}

void modulate(cv::Mat& canvas, const cv::Mat& field, double amount) {
  for (int y = 0; y < canvas.rows; ++y) {
    auto* pixel = canvas.ptr<cv::Vec3b>(y);
    const float* value = field.ptr<float>(y);
    for (int x = 0; x < canvas.cols; ++x) {
      const double factor = 1 + amount * 2 * (value[x] - 0.5);
      for (int c = 0; c < 3; ++c) pixel[x][c] = cv::saturate_cast<uchar>(pixel[x][c] * factor);
    }
  }
}

cv::Mat mottled(cv::Size size, const cv::Scalar& colour, double amount, cv::Size cells, int octaves,
                uint64_t key) {
  cv::Mat canvas(size, CV_8UC3, colour);
  modulate(canvas, noise(size, cells, octaves, key), amount);
  return canvas;
}

void fill(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& colour) {
  if (box.width > 0 && box.height > 0) cv::rectangle(canvas, box, colour, cv::FILLED);
}

void frame(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& colour, int width_px) {
  if (box.width > 0 && box.height > 0) cv::rectangle(canvas, box, colour, width_px, cv::LINE_AA);
}

void write(cv::Mat& canvas, const std::string& text, cv::Point at, double height_px, const cv::Scalar& colour,
           int width_px) {
  constexpr double kHersheyCapital_px = 21;  // height of capitals at scale 1
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, height_px / kHersheyCapital_px, colour, width_px,
              cv::LINE_AA);
}

std::string word(Dice& dice) {
  static const std::array<const char*, 48> kWords = {
      "stereo",    "vision", "laser",  "camera",  "the",    "of",      "and",     "robot",  "pose",   "error",
      "metrology", "a",      "planar", "motion",  "range",  "signal",  "with",    "lens",   "noise",  "map",
      "fringe",    "to",     "in",     "voltage", "phase",  "optical", "thermal", "sensor", "matrix", "is",
      "from",      "field",  "length", "scale",   "gauge",  "time",    "mirror",  "beam",   "path",   "drift",
      "line",      "for",    "depth",  "method",  "result", "figure",  "model",   "test"};
  return kWords[dice.integer(0, kWords.size() - 1)];
}

void paragraph(cv::Mat& canvas, const cv::Rect& box, double height_px, const cv::Scalar& colour, Dice& dice) {
  cv::Mat area = canvas(box & cv::Rect({0, 0}, canvas.size()));
  const double step_px = 1.75 * height_px, advance_px = 0.9 * height_px;
  for (double y = 1.2 * height_px; y < area.rows; y += step_px) {
    std::string line;
    // Last line of a paragraph is shorter, then a gap.
    const double width_px = dice.chance(0.2) ? area.cols * dice.uniform(0.3, 0.8) : area.cols;
    while (true) {
      const std::string next = word(dice);
      if ((line.size() + next.size()) * advance_px > width_px) break;
      line += next + " ";
    }
    write(area, line, {0, static_cast<int>(y)}, height_px, colour);
    if (width_px < area.cols) y += 0.6 * step_px;
  }
}

void plot(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& ground, const cv::Scalar& ink, Dice& dice) {
  fill(canvas, box, ground);
  const cv::Point origin(box.x + box.width / 10, box.y + box.height * 9 / 10);
  const cv::Point end(box.x + box.width * 19 / 20, box.y + box.height / 14);
  cv::line(canvas, origin, {end.x, origin.y}, ink, 2, cv::LINE_AA);
  cv::line(canvas, origin, {origin.x, end.y}, ink, 2, cv::LINE_AA);
  for (int tick = 1; tick < 8; ++tick) {
    const int x = origin.x + (end.x - origin.x) * tick / 8, y = origin.y + (end.y - origin.y) * tick / 8;
    cv::line(canvas, {x, origin.y - 4}, {x, origin.y + 4}, ink, 1, cv::LINE_AA);
    cv::line(canvas, {origin.x - 4, y}, {origin.x + 4, y}, ink, 1, cv::LINE_AA);
  }
  const int curves = dice.integer(1, 3);
  for (int curve = 0; curve < curves; ++curve) {
    const cv::Scalar colour = rgb(dice.uniform(0, 220), dice.uniform(0, 160), dice.uniform(0, 220));
    const double rate = dice.uniform(2, 9), phase = dice.uniform(0, 6), decay = dice.uniform(0, 2);
    cv::Point last;
    for (int i = 0; i <= 60; ++i) {
      const double t = i / 60.0;
      const double value =
          0.5 + 0.4 * std::sin(rate * t + phase) * std::exp(-decay * t) + dice.uniform(-0.03, 0.03);
      const cv::Point at(origin.x + static_cast<int>((end.x - origin.x) * t),
                         origin.y + static_cast<int>((end.y - origin.y) * value));
      if (i > 0) cv::line(canvas, last, at, colour, 2, cv::LINE_AA);
      last = at;
    }
  }
}

}  // namespace groundloop::textures
