#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace groundloop::bench {

/// sRGB colour written as on the web: Colour(0x1f77b4).
struct Colour {
  uint32_t rgb = 0;
  constexpr explicit Colour(uint32_t value) : rgb(value) {}
  cv::Vec3b bgr() const {
    return {static_cast<uint8_t>(rgb), static_cast<uint8_t>(rgb >> 8), static_cast<uint8_t>(rgb >> 16)};
  }
  cv::Scalar scalar() const { return cv::Scalar(bgr()); }
};

namespace palette {
inline constexpr Colour kPaper(0xffffff);
inline constexpr Colour kInk(0x1b2430);
inline constexpr Colour kSoftInk(0x5b6673);
inline constexpr Colour kGrid(0xd9dee5);
inline constexpr Colour kTruth(0x1b2430);
inline constexpr Colour kEstimate(0xe8384f);
inline constexpr Colour kKeyFrame(0x8a1538);
inline constexpr Colour kWithoutLinks(0xf08c2e);
inline constexpr Colour kLink(0x7a3fc4);
inline constexpr Colour kStart(0x12905a);
inline constexpr Colour kEnd(0x1f5fd0);
inline constexpr Colour kThing(0xdfe4ea);
inline constexpr Colour kThingEdge(0x8a95a3);
}  // namespace palette

enum class Align { kLeft, kCentre, kRight };

/// Draws at twice the size and halves at the end, so that everything, text included, has smooth edges.
/// Coordinates are pixels of the final image; (0, 0) is its upper left corner.
class Canvas {
 public:
  static constexpr int kScale = 2;

  Canvas(int width, int height, Colour background);

  void line(cv::Point2d a, cv::Point2d b, Colour colour, double width);
  void polyline(const std::vector<cv::Point2d>& points, Colour colour, double width, bool closed = false);
  void polygon(const std::vector<cv::Point2d>& points, Colour colour, double alpha = 1);
  void disc(cv::Point2d centre, double radius, Colour colour);
  void circle(cv::Point2d centre, double radius, Colour colour, double width);
  void rectangle(cv::Rect2d area, Colour colour, double alpha = 1);
  void frame(cv::Rect2d area, Colour colour, double width);
  /// `at` is on the baseline of the text; size is the height of a capital in px.
  void text(cv::Point2d at, const std::string& text, double size, Colour colour, Align align = Align::kLeft);
  /// Text on a pale outline, readable on any ground.
  void label(cv::Point2d at, const std::string& text, double size, Colour colour, Align align = Align::kLeft);
  /// Copies a picture of the final image's resolution, enlarged without smoothing.
  void picture(cv::Point corner, const cv::Mat& bgr);

  static double text_width(const std::string& text, double size);

  /// The double-size picture, for what draws pixel by pixel.
  cv::Mat& pixels() { return pixels_; }
  cv::Mat image() const;

 private:
  cv::Mat pixels_;
};

/// One entry of a legend.
struct LegendItem {
  enum class Mark { kLine, kDisc, kBox, kHeading };
  Mark mark;
  Colour colour;
  std::string text;
};

/// Draws entries in a row from `at` (baseline of the first text) and wraps before `right_limit`.
void draw_legend(Canvas& canvas, cv::Point2d at, double right_limit, const std::vector<LegendItem>& items);

/// A colour bar along the longer side of the area; `colours` from bottom to top or from left to right.
void draw_colour_bar(Canvas& canvas, cv::Rect area, const std::vector<cv::Vec3b>& colours);

/// 256 BGR colours of an OpenCV colour map (cv::COLORMAP_...), lowest value first.
std::vector<cv::Vec3b> colour_map(int opencv_map);

/// Largest of 1, 2, 5 * 10^k that is not above x > 0; next_nice_step the smallest not below.
double nice_step_below(double x);
double nice_step_above(double x);

/// A number with just the decimals that a scale of this step needs.
std::string tick_text(double value, double step);

/// An axis-aligned box on the floor [m].
struct Bounds {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d max = Eigen::Vector2d::Constant(-1e300);
  bool empty() const { return !(min.x() <= max.x()); }
  Eigen::Vector2d size() const { return max - min; }
  void add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  Bounds grown(double by_m) const {
    return {min - Eigen::Vector2d::Constant(by_m), max + Eigen::Vector2d::Constant(by_m)};
  }
};

/// Maps the floor plane (x right, y up, metres) to pixels of a panel, one scale for both axes.
class PlanView {
 public:
  /// The bounds fill the panel's width, unless the panel would get higher than max_height: then they are
  /// centred.
  PlanView(const Bounds& bounds, cv::Point2d corner, double width, double max_height);

  cv::Point2d operator()(double x_m, double y_m) const {
    return {panel_.x + (x_m - x_min_m_) * px_per_m_, panel_.y + panel_.height - (y_m - y_min_m_) * px_per_m_};
  }
  cv::Point2d operator()(const Eigen::Vector2d& p) const { return (*this)(p.x(), p.y()); }
  /// Point of the floor under a pixel.
  Eigen::Vector2d metres(double x_px, double y_px) const {
    return {x_min_m_ + (x_px - panel_.x) / px_per_m_,
            y_min_m_ + (panel_.y + panel_.height - y_px) / px_per_m_};
  }
  const cv::Rect2d& panel() const { return panel_; }
  double px_per_m() const { return px_per_m_; }

  void draw_grid(Canvas& canvas, Colour colour) const;
  /// Frame, ticks with numbers, "x [m]" and "y [m]".
  void draw_axes(Canvas& canvas) const;

 private:
  double step_m() const;
  cv::Rect2d panel_;
  double x_min_m_;
  double y_min_m_;
  double px_per_m_;
};

}  // namespace groundloop::bench
