#include "bench/report/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace groundloop::bench {
namespace {

constexpr int kShift = 4;  // fractional bits of OpenCV's drawing coordinates
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapital = 21;  // height of this font's capitals at scale 1

/// Final-image coordinates -> fixed-point coordinates of the double-size picture.
cv::Point fixed(cv::Point2d p) {
  constexpr double kFactor = Canvas::kScale * (1 << kShift);
  const auto clamped = [](double v) { return std::clamp(v, -1e5, 1e5); };  // keeps 32-bit coordinates safe
  return {cvRound(clamped(p.x) * kFactor), cvRound(clamped(p.y) * kFactor)};
}

std::vector<cv::Point> fixed(const std::vector<cv::Point2d>& points) {
  std::vector<cv::Point> result;
  result.reserve(points.size());
  for (const auto& p : points) result.push_back(fixed(p));
  return result;
}

int stroke(double width) { return std::max(1, cvRound(width * Canvas::kScale)); }

double font_scale(double size) { return size * Canvas::kScale / kCapital; }

int font_stroke(double size) { return std::max(1, cvRound(size * Canvas::kScale / 10.0)); }

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : pixels_(height * kScale, width * kScale, CV_8UC3, background.scalar()) {}

void Canvas::line(cv::Point2d a, cv::Point2d b, Colour colour, double width) {
  cv::line(pixels_, fixed(a), fixed(b), colour.scalar(), stroke(width), cv::LINE_AA, kShift);
}

void Canvas::polyline(const std::vector<cv::Point2d>& points, Colour colour, double width, bool closed) {
  if (points.size() < 2) return;
  const std::vector<std::vector<cv::Point>> lines = {fixed(points)};
  cv::polylines(pixels_, lines, closed, colour.scalar(), stroke(width), cv::LINE_AA, kShift);
}

void Canvas::polygon(const std::vector<cv::Point2d>& points, Colour colour, double alpha) {
  if (points.size() < 3) return;
  const std::vector<std::vector<cv::Point>> lines = {fixed(points)};
  if (alpha >= 1) return cv::fillPoly(pixels_, lines, colour.scalar(), cv::LINE_AA, kShift);
  std::vector<cv::Point2f> corners;
  corners.reserve(points.size());
  for (const auto& p : points) corners.emplace_back(p * kScale);
  const cv::Rect around = cv::boundingRect(corners);
  const cv::Rect area = cv::Rect(around.x - 2, around.y - 2, around.width + 4, around.height + 4) &
                        cv::Rect({}, pixels_.size());
  if (area.empty()) return;
  cv::Mat ground = pixels_(area), painted = ground.clone();
  const cv::Point offset(area.x << kShift, area.y << kShift);
  std::vector<std::vector<cv::Point>> moved = lines;
  for (auto& p : moved[0]) p -= offset;
  cv::fillPoly(painted, moved, colour.scalar(), cv::LINE_AA, kShift);
  cv::addWeighted(painted, alpha, ground, 1 - alpha, 0, ground);
}

void Canvas::disc(cv::Point2d centre, double radius, Colour colour) {
  const int r = cvRound(radius * kScale * (1 << kShift));
  cv::circle(pixels_, fixed(centre), r, colour.scalar(), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::circle(cv::Point2d centre, double radius, Colour colour, double width) {
  const int r = cvRound(radius * kScale * (1 << kShift));
  cv::circle(pixels_, fixed(centre), r, colour.scalar(), stroke(width), cv::LINE_AA, kShift);
}

void Canvas::rectangle(cv::Rect2d area, Colour colour, double alpha) {
  polygon({area.tl(), {area.x + area.width, area.y}, area.br(), {area.x, area.y + area.height}}, colour,
          alpha);
}

void Canvas::frame(cv::Rect2d area, Colour colour, double width) {
  polyline({area.tl(), {area.x + area.width, area.y}, area.br(), {area.x, area.y + area.height}}, colour,
           width, true);
}

double Canvas::text_width(const std::string& text, double size) {
  int baseline = 0;
  return static_cast<double>(
             cv::getTextSize(text, kFont, font_scale(size), font_stroke(size), &baseline).width) /
         kScale;
}

void Canvas::text(cv::Point2d at, const std::string& text, double size, Colour colour, Align align) {
  const double width = text_width(text, size);
  if (align == Align::kCentre) at.x -= width / 2;
  if (align == Align::kRight) at.x -= width;
  cv::putText(pixels_, text, cv::Point(cvRound(at.x * kScale), cvRound(at.y * kScale)), kFont,
              font_scale(size), colour.scalar(), font_stroke(size), cv::LINE_AA);
}

void Canvas::label(cv::Point2d at, const std::string& text, double size, Colour colour, Align align) {
  const double width = text_width(text, size);
  if (align == Align::kCentre) at.x -= width / 2;
  if (align == Align::kRight) at.x -= width;
  const cv::Point corner(cvRound(at.x * kScale), cvRound(at.y * kScale));
  cv::putText(pixels_, text, corner, kFont, font_scale(size), palette::kPaper.scalar(), font_stroke(size) + 8,
              cv::LINE_AA);
  cv::putText(pixels_, text, corner, kFont, font_scale(size), colour.scalar(), font_stroke(size),
              cv::LINE_AA);
}

void Canvas::picture(cv::Point corner, const cv::Mat& bgr) {
  const cv::Rect area(corner * kScale, bgr.size() * kScale);
  cv::resize(bgr, pixels_(area), area.size(), 0, 0, cv::INTER_NEAREST);
}

cv::Mat Canvas::image() const {
  cv::Mat halved;
  cv::resize(pixels_, halved, pixels_.size() / kScale, 0, 0, cv::INTER_AREA);
  return halved;
}

void draw_legend(Canvas& canvas, cv::Point2d at, double right_limit, const std::vector<LegendItem>& items) {
  constexpr double kSize = 11, kMarkWidth = 26, kGap = 30, kLineHeight = 28;
  const double left = at.x;
  for (const auto& item : items) {
    const double width = kMarkWidth + 8 + Canvas::text_width(item.text, kSize);
    if (at.x > left && at.x + width > right_limit) at = {left, at.y + kLineHeight};
    const cv::Point2d middle(at.x + kMarkWidth / 2, at.y - kSize / 2);
    switch (item.mark) {
      case LegendItem::Mark::kLine:
        canvas.line({at.x, middle.y}, {at.x + kMarkWidth, middle.y}, item.colour, 3);
        break;
      case LegendItem::Mark::kDisc:
        canvas.disc(middle, 6, item.colour);
        break;
      case LegendItem::Mark::kBox:
        canvas.rectangle({at.x + 3, middle.y - 8, kMarkWidth - 6, 16}, item.colour);
        canvas.frame({at.x + 3, middle.y - 8, kMarkWidth - 6, 16}, palette::kThingEdge, 0.5);
        break;
      case LegendItem::Mark::kHeading:
        canvas.disc({at.x + 5, middle.y}, 4, item.colour);
        canvas.line({at.x + 5, middle.y}, {at.x + kMarkWidth, middle.y}, item.colour, 1.5);
        break;
    }
    canvas.text({at.x + kMarkWidth + 8, at.y}, item.text, kSize, palette::kInk);
    at.x += width + kGap;
  }
}

void draw_colour_bar(Canvas& canvas, cv::Rect area, const std::vector<cv::Vec3b>& colours) {
  cv::Mat bar(area.size(), CV_8UC3);
  const auto colour_at = [&](double fraction) {
    return cv::Scalar(colours[static_cast<size_t>(fraction * static_cast<double>(colours.size()))]);
  };
  const bool upright = area.height > area.width;
  for (int i = 0; i < std::max(area.width, area.height); ++i) {
    (upright ? bar.row(i) : bar.col(i))
        .setTo(colour_at(upright ? 1 - (i + 0.5) / area.height : (i + 0.5) / area.width));
  }
  canvas.picture(area.tl(), bar);
}

std::vector<cv::Vec3b> colour_map(int opencv_map) {
  cv::Mat ramp(1, 256, CV_8UC1), coloured;
  for (int i = 0; i < 256; ++i) ramp.at<uint8_t>(i) = static_cast<uint8_t>(i);
  cv::applyColorMap(ramp, coloured, opencv_map);
  return {coloured.begin<cv::Vec3b>(), coloured.end<cv::Vec3b>()};
}

double nice_step_below(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  return x >= 5 * power ? 5 * power : x >= 2 * power ? 2 * power : power;
}

double nice_step_above(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  return x <= power ? power : x <= 2 * power ? 2 * power : x <= 5 * power ? 5 * power : 10 * power;
}

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value) < step / 2 ? 0.0 : value, decimals);
}

PlanView::PlanView(const Bounds& bounds, cv::Point2d corner, double width, double max_height) {
  const Eigen::Vector2d size = bounds.size().cwiseMax(0.1);
  px_per_m_ = std::min(width / size.x(), max_height / size.y());
  panel_ = {corner.x, corner.y, width, std::floor(size.y() * px_per_m_)};
  x_min_m_ = bounds.min.x() - (width / px_per_m_ - size.x()) / 2;
  y_min_m_ = bounds.min.y();
}

double PlanView::step_m() const { return nice_step_above(70 / px_per_m_); }

void PlanView::draw_grid(Canvas& canvas, Colour colour) const {
  const double step = step_m();
  const Eigen::Vector2d low = metres(panel_.x, panel_.y + panel_.height);
  const Eigen::Vector2d high = metres(panel_.x + panel_.width, panel_.y);
  for (double i = std::ceil(low.x() / step); i * step <= high.x(); ++i) {
    canvas.line((*this)(i * step, low.y()), (*this)(i * step, high.y()), colour, 1);
  }
  for (double i = std::ceil(low.y() / step); i * step <= high.y(); ++i) {
    canvas.line((*this)(low.x(), i * step), (*this)(high.x(), i * step), colour, 1);
  }
}

void PlanView::draw_axes(Canvas& canvas) const {
  constexpr double kSize = 11;
  const double step = step_m();
  const double bottom = panel_.y + panel_.height;
  const Eigen::Vector2d low = metres(panel_.x, bottom);
  const Eigen::Vector2d high = metres(panel_.x + panel_.width, panel_.y);
  canvas.frame(panel_, palette::kSoftInk, 1);
  for (double i = std::ceil(low.x() / step); i * step <= high.x(); ++i) {
    const cv::Point2d at = (*this)(i * step, low.y());
    canvas.line(at, {at.x, bottom + 6}, palette::kSoftInk, 1);
    if (at.x > panel_.x + panel_.width - 70) continue;  // the unit stands there
    canvas.text({at.x, bottom + 23}, tick_text(i * step, step), kSize, palette::kSoftInk, Align::kCentre);
  }
  for (double i = std::ceil(low.y() / step); i * step <= high.y(); ++i) {
    const cv::Point2d at = (*this)(low.x(), i * step);
    canvas.line(at, {panel_.x - 6, at.y}, palette::kSoftInk, 1);
    if (at.y < panel_.y + 24) continue;
    canvas.text({panel_.x - 11, at.y + kSize / 2}, tick_text(i * step, step), kSize, palette::kSoftInk,
                Align::kRight);
  }
  canvas.text({panel_.x + panel_.width, bottom + 23}, "x [m]", kSize, palette::kInk, Align::kRight);
  canvas.text({panel_.x - 11, panel_.y + kSize}, "y [m]", kSize, palette::kInk, Align::kRight);
}

}  // namespace groundloop::bench
