#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <opencv2/imgproc.hpp>

#include "bench/report/canvas.h"
#include "bench/report/figures.h"

namespace groundloop::bench {
namespace {

constexpr double kWidth_px = 1280;
constexpr int kLegendHeight = 60;
constexpr double kTextSize = 16;
constexpr Colour kInlier(0x2ee6a6);
constexpr Colour kNew(0xffc83d);
constexpr Colour kOutlier(0xff4b5c);
constexpr Colour kTail(0x4aa8ff);
constexpr Colour kDark(0x14181f);
constexpr Colour kPaleText(0xe6eaf0);

double enlargement(const cv::Mat& image) { return std::max(1.0, std::round(kWidth_px / image.cols)); }

/// Where each living feature was, oldest first.
std::map<int64_t, std::vector<cv::Point2d>> tails_of(
    const std::vector<std::vector<slam::FeatureObservation>>& history) {
  std::map<int64_t, std::vector<cv::Point2d>> tails;
  for (const auto& frame : history) {
    for (const auto& f : frame) tails[f.id].emplace_back(f.u_left_px, f.v_left_px);
  }
  return tails;
}

void draw_mark(Canvas& canvas, cv::Point2d at, const slam::FeatureObservation& f) {
  if (f.is_new) {
    canvas.frame({at.x - 6, at.y - 6, 12, 12}, kNew, 2);
  } else if (f.is_inlier) {
    canvas.circle(at, 7, kInlier, 2);
  } else {
    canvas.line({at.x - 6, at.y - 6}, {at.x + 6, at.y + 6}, kOutlier, 2.2);
    canvas.line({at.x - 6, at.y + 6}, {at.x + 6, at.y - 6}, kOutlier, 2.2);
  }
}

Colour colour_of(const slam::FeatureObservation& f) {
  return f.is_new ? kNew : f.is_inlier ? kInlier : kOutlier;
}

void draw_feature_legend(Canvas& canvas, double top, const std::vector<slam::FeatureObservation>& features,
                         bool with_tails) {
  int fresh = 0, inliers = 0;
  for (const auto& f : features) {
    fresh += f.is_new ? 1 : 0;
    inliers += !f.is_new && f.is_inlier ? 1 : 0;
  }
  const int outliers = static_cast<int>(features.size()) - fresh - inliers;
  const double middle = top + kLegendHeight / 2.0, baseline = middle + kTextSize / 2;
  cv::Point2d at(24, middle);
  const auto name = [&](double from, const std::string& text) {
    canvas.text({at.x + from, baseline}, text, kTextSize, kPaleText);
    at.x += from + Canvas::text_width(text, kTextSize) + 34;
  };
  const auto mark = [&](const slam::FeatureObservation& sample, const std::string& text) {
    draw_mark(canvas, at, sample);
    name(16, text);
  };
  const auto stroke = [&](Colour colour, const std::string& text) {
    canvas.line({at.x - 8, middle}, {at.x + 14, middle}, colour, 2.5);
    name(22, text);
  };
  mark({.is_inlier = true}, fmt::format("inlier {}", inliers));
  mark({}, fmt::format("outlier {}", outliers));
  mark({.is_new = true}, fmt::format("new {}", fresh));
  stroke(kPaleText, "disparity / 4");
  if (with_tails) stroke(kTail, "motion before");
}

}  // namespace

cv::Mat draw_tracked(const cv::Mat& left, const std::vector<slam::FeatureObservation>& features,
                     const std::vector<std::vector<slam::FeatureObservation>>& history) {
  const double zoom = enlargement(left);
  const cv::Size size(cvRound(left.cols * zoom), cvRound(left.rows * zoom));
  Canvas canvas(size.width, size.height + kLegendHeight, kDark);

  // the image, enlarged smoothly and a little darker so that the marks stand out
  cv::Mat grey, bgr;
  cv::resize(left, grey, size * Canvas::kScale, 0, 0, cv::INTER_CUBIC);
  grey.convertTo(grey, CV_8U, 0.82);
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  bgr.copyTo(canvas.pixels()(cv::Rect(cv::Point(), bgr.size())));

  // the centre of the first pixel is (0, 0)
  const auto pixel = [&](double u, double v) { return cv::Point2d((u + 0.5) * zoom, (v + 0.5) * zoom); };
  const auto tails = tails_of(history);
  for (const auto& f : features) {
    const auto tail = tails.find(f.id);
    if (tail == tails.end()) continue;
    std::vector<cv::Point2d> points;
    for (const auto& p : tail->second) points.push_back(pixel(p.x, p.y));
    points.push_back(pixel(f.u_left_px, f.v_left_px));
    canvas.polyline(points, kTail, 2);
  }
  for (const auto& f : features) {
    const cv::Point2d at = pixel(f.u_left_px, f.v_left_px);
    if (f.has_right)
      canvas.line(at, at - cv::Point2d((f.u_left_px - f.u_right_px) * zoom / 4, 0), colour_of(f), 1.5);
    draw_mark(canvas, at, f);
  }
  canvas.rectangle({0, static_cast<double>(size.height), static_cast<double>(size.width), kLegendHeight},
                   kDark);
  draw_feature_legend(canvas, size.height, features, !history.empty());
  return canvas.image();
}

namespace {

/// Upper end of the colour scale [full-resolution px]: nearly all known disparities lie below.
double scale_end_px(const cv::Mat& disparity) {
  std::vector<int16_t> known;
  std::copy_if(disparity.begin<int16_t>(), disparity.end<int16_t>(), std::back_inserter(known),
               [](int16_t d) { return d >= 0; });
  if (known.empty()) return 10;
  const auto rank = known.begin() + static_cast<long>(0.995 * static_cast<double>(known.size() - 1));
  std::nth_element(known.begin(), rank, known.end());
  return std::max(5.0, std::ceil(*rank / 8.0 / 5) * 5);
}

cv::Mat coloured_disparity(const cv::Mat& disparity, double end_px, const std::vector<cv::Vec3b>& colours) {
  cv::Mat image(disparity.size(), CV_8UC3, kDark.scalar());
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      const int16_t d = disparity.at<int16_t>(v, u);
      if (d < 0) continue;
      const double fraction = std::min(1.0, d / 8.0 / end_px);  // half-resolution px * 16 -> px: / 8
      image.at<cv::Vec3b>(v, u) = colours[static_cast<size_t>(fraction * 255)];
    }
  }
  return image;
}

}  // namespace

cv::Mat draw_disparity(const cv::Mat& disparity, const slam::StereoRig& rig) {
  const int zoom = static_cast<int>(enlargement(disparity));
  const cv::Size size = disparity.size() * zoom;
  const double end_px = scale_end_px(disparity);
  // turbo without its darkest blues, which would look like "unknown"
  auto colours = colour_map(cv::COLORMAP_TURBO);
  for (size_t i = 0; i < colours.size(); ++i) colours[i] = colours[std::min<size_t>(255, 18 + i * 237 / 255)];

  constexpr int kStripHeight = 108, kBarHeight = 24, kLeft = 64;
  Canvas canvas(size.width, size.height + kStripHeight, palette::kPaper);
  cv::Mat image;
  cv::resize(coloured_disparity(disparity, end_px, colours), image, size, 0, 0, cv::INTER_NEAREST);
  canvas.picture({0, 0}, image);

  const cv::Rect bar(kLeft, size.height + 42, size.width - kLeft - 250, kBarHeight);
  draw_colour_bar(canvas, bar, colours);
  canvas.frame(bar, palette::kSoftInk, 1);
  const double above = bar.y - 10, below = bar.y + kBarHeight + kTextSize + 10;
  canvas.text({14, above}, "px", kTextSize, palette::kInk);
  canvas.text({14, below}, "m", kTextSize, palette::kInk);
  const double step = nice_step_above(end_px / 9);
  for (double i = 0; i * step <= end_px + 1e-9; ++i) {
    const double d = i * step, x = bar.x + bar.width * d / end_px;
    canvas.line({x, bar.y - 5.0}, {x, bar.y + kBarHeight + 5.0}, palette::kSoftInk, 1.5);
    canvas.text({x, above}, tick_text(d, step), kTextSize, palette::kSoftInk, Align::kCentre);
    const double parallax = d - rig.disparity_at_infinity_px();
    const std::string metres =
        parallax > 1e-6 ? fmt::format("{:.2g}", rig.fx_px * rig.baseline_m / parallax) : "inf";
    canvas.text({x, below}, metres, kTextSize, palette::kSoftInk, Align::kCentre);
  }
  canvas.rectangle({size.width - 190.0, static_cast<double>(bar.y), 40, kBarHeight}, kDark);
  canvas.text({size.width - 140.0, bar.y + (kBarHeight + kTextSize) / 2}, "unknown", kTextSize,
              palette::kSoftInk);
  return canvas.image();
}

}  // namespace groundloop::bench
