#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "bench/report/canvas.h"
#include "bench/report/figures.h"
#include "bench/report/plan_drawing.h"

namespace groundloop::bench {
namespace {

constexpr int kWidth = 1600;
constexpr double kLeft = 74, kRight = 96, kTop = 22, kBottom = 84;
constexpr double kLegendLine = 28;  // what a second line of the legend needs
constexpr double kMaxHeight = 1300;

/// Value below which a fraction of the values lies; reorders them.
float quantile(std::vector<float>& values, double fraction) {
  const auto rank = values.begin() + static_cast<long>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

/// What must be in the picture: paths and scene; without a scene, the bulk of the cloud as well.
Bounds bounds_of(const TopView& view) {
  Bounds bounds;
  for (const auto* trajectory : {&view.truth, &view.estimate, &view.without_links}) {
    for (const auto& pose : *trajectory) bounds.add(pose.T.translation().head<2>());
  }
  for (const Footprint& footprint : view.outline) {
    for (const auto& p : footprint.polygon) bounds.add(p);
  }
  if (view.outline.empty() && !view.cloud.empty()) {
    std::vector<float> x, y;
    for (const DrawnPoint& point : view.cloud) {
      x.push_back(point.p.x());
      y.push_back(point.p.y());
    }
    bounds.add({quantile(x, 0.05), quantile(y, 0.05)});
    bounds.add({quantile(x, 0.95), quantile(y, 0.95)});
  }
  if (bounds.empty()) bounds.add({0, 0});
  return bounds.grown(std::max(0.3, 0.02 * bounds.size().maxCoeff()));
}

struct Heights {
  double low_m;
  double high_m;
};

Heights height_range(const std::vector<DrawnPoint>& cloud) {
  std::vector<float> z;
  z.reserve(cloud.size());
  for (const DrawnPoint& point : cloud) z.push_back(point.p.z());
  const double low_m = std::floor(quantile(z, 0.02) * 4) / 4, high_m = std::ceil(quantile(z, 0.98) * 4) / 4;
  return {low_m, std::max(high_m, low_m + 0.5)};
}

/// Points from low to high, coloured by height; the more uncertain, the fainter.
void draw_cloud(Canvas& canvas, const PlanView& view, std::vector<DrawnPoint> cloud, const Heights& heights,
                const std::vector<cv::Vec3b>& colours) {
  std::stable_sort(cloud.begin(), cloud.end(),
                   [](const DrawnPoint& a, const DrawnPoint& b) { return a.p.z() < b.p.z(); });
  const cv::Rect area(cvRound(view.panel().x * Canvas::kScale), cvRound(view.panel().y * Canvas::kScale),
                      cvRound(view.panel().width * Canvas::kScale),
                      cvRound(view.panel().height * Canvas::kScale));
  constexpr int kSide = 4;  // of a point, in double-size pixels
  for (const DrawnPoint& point : cloud) {
    const double fraction = (point.p.z() - heights.low_m) / (heights.high_m - heights.low_m);
    const cv::Vec3b colour = colours[static_cast<size_t>(std::clamp(fraction, 0.0, 1.0) * 255)];
    const double alpha = std::clamp(0.08 / std::max(1e-3, static_cast<double>(point.sigma_m)), 0.25, 0.75);
    const cv::Point2d at = view(point.p.x(), point.p.y());
    if (!view.panel().contains(at)) continue;
    const cv::Rect spot = cv::Rect(cvRound(at.x * Canvas::kScale) - kSide / 2,
                                   cvRound(at.y * Canvas::kScale) - kSide / 2, kSide, kSide) &
                          area;
    for (int v = spot.y; v < spot.br().y; ++v) {
      for (int u = spot.x; u < spot.br().x; ++u) {
        cv::Vec3b& pixel = canvas.pixels().at<cv::Vec3b>(v, u);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = static_cast<uint8_t>(std::lround(alpha * colour[c] + (1 - alpha) * pixel[c]));
        }
      }
    }
  }
}

/// Key frames, thinned where they would hide each other.
void draw_key_frames(Canvas& canvas, const PlanView& view, const std::vector<slam::Pose>& key_frames) {
  constexpr double kSpacing_px = 40, kTurn_rad = 0.3;
  std::optional<PlanPose> last;
  for (const slam::Pose& T_frame_left : key_frames) {
    const PlanPose pose = heading_of_camera(T_frame_left);
    if (last) {
      const double moved_px = std::hypot(pose.x_m - last->x_m, pose.y_m - last->y_m) * view.px_per_m();
      const double turned_rad = std::abs(std::remainder(pose.yaw_rad - last->yaw_rad, 2 * M_PI));
      if (moved_px < kSpacing_px && turned_rad < kTurn_rad) continue;
    }
    draw_heading(canvas, view, pose, 18, palette::kKeyFrame);
    last = pose;
  }
}

/// Thin lines from where a place was seen first to where it was recognised; wrong ones are crossed out.
void draw_links(Canvas& canvas, const PlanView& view, const std::vector<DrawnLink>& links) {
  for (const DrawnLink& link : links) {
    const cv::Point2d from = view(link.from.head<2>()), to = view(link.to.head<2>());
    const Colour colour = link.wrong ? palette::kEstimate : palette::kLink;
    canvas.line(from, to, colour, 0.9);
    canvas.disc(from, 2.2, colour);
    canvas.disc(to, 2.2, colour);
    if (!link.wrong) continue;
    const cv::Point2d middle = (from + to) / 2;
    canvas.line(middle - cv::Point2d(5, 5), middle + cv::Point2d(5, 5), colour, 1.8);
    canvas.line(middle - cv::Point2d(5, -5), middle + cv::Point2d(5, -5), colour, 1.8);
  }
}

void draw_height_bar(Canvas& canvas, const PlanView& view, const Heights& heights,
                     const std::vector<cv::Vec3b>& colours) {
  const int height = static_cast<int>(std::min(360.0, view.panel().height - 60));
  const cv::Rect bar(kWidth - 74, cvRound(view.panel().y) + 36, 18, height);
  draw_colour_bar(canvas, bar, colours);
  canvas.frame(bar, palette::kSoftInk, 1);
  canvas.text({kWidth - 8.0, bar.y - 14.0}, "height [m]", 10, palette::kInk, Align::kRight);
  const double range_m = heights.high_m - heights.low_m, step = nice_step_above(range_m / 7);
  for (double i = std::ceil(heights.low_m / step - 1e-9); i * step <= heights.high_m + 1e-9; ++i) {
    const double y = bar.y + bar.height * (1 - (i * step - heights.low_m) / range_m);
    canvas.line({bar.x + bar.width + 0.0, y}, {bar.x + bar.width + 5.0, y}, palette::kSoftInk, 1);
    canvas.text({bar.x + bar.width + 9.0, y + 5}, tick_text(i * step, step), 10, palette::kSoftInk);
  }
}

std::vector<LegendItem> legend_of(const TopView& view) {
  using Mark = LegendItem::Mark;
  std::vector<LegendItem> items;
  if (!view.truth.empty()) items.push_back({Mark::kLine, palette::kTruth, "true trajectory"});
  if (!view.estimate.empty()) items.push_back({Mark::kLine, palette::kEstimate, "estimated trajectory"});
  if (!view.without_links.empty()) {
    items.push_back({Mark::kLine, palette::kWithoutLinks, "the same without links"});
  }
  if (!view.links.empty()) {
    const auto wrong =
        std::count_if(view.links.begin(), view.links.end(), [](const DrawnLink& l) { return l.wrong; });
    std::string text = fmt::format("recognised places ({})", view.links.size());
    if (wrong > 0) text.insert(text.size() - 1, fmt::format(", {} wrong", wrong));
    items.push_back({Mark::kLine, palette::kLink, text});
  }
  if (!view.key_frames.empty())
    items.push_back({Mark::kHeading, palette::kKeyFrame, "key frame and heading"});
  if (!view.cloud.empty()) {
    items.push_back(
        {Mark::kDisc, Colour(0x21918c), fmt::format("point cloud ({} points)", view.cloud.size())});
  }
  if (!view.outline.empty()) items.push_back({Mark::kBox, palette::kThing, "scene"});
  return items;
}

}  // namespace

cv::Mat draw_top_view(const TopView& view) {
  const PlanView plan(bounds_of(view), {kLeft, kTop}, kWidth - kLeft - kRight, kMaxHeight);
  const double more = view.links.empty() && view.without_links.empty() ? 0 : kLegendLine;
  Canvas canvas(kWidth, cvRound(kTop + plan.panel().height + kBottom + more), palette::kPaper);
  plan.draw_grid(canvas, palette::kGrid);
  draw_outline(canvas, plan, view.outline, false);
  if (!view.cloud.empty()) {
    const Heights heights = height_range(view.cloud);
    const auto colours = colour_map(cv::COLORMAP_VIRIDIS);
    draw_cloud(canvas, plan, view.cloud, heights, colours);
    draw_height_bar(canvas, plan, heights, colours);
  }
  draw_path(canvas, plan, view.truth, palette::kPaper, 7);  // a pale rim keeps the path readable on the cloud
  draw_path(canvas, plan, view.truth, palette::kTruth, 4);
  draw_path(canvas, plan, view.without_links, palette::kWithoutLinks, 1.2);
  draw_path(canvas, plan, view.estimate, palette::kEstimate, 1.8);
  draw_key_frames(canvas, plan, view.key_frames);
  draw_links(canvas, plan, view.links);
  const slam::Trajectory& marked = view.truth.empty() ? view.estimate : view.truth;
  if (!marked.empty()) {
    draw_place(canvas, plan, heading_of_camera(marked.back().T), "end", palette::kEnd, true);
    draw_place(canvas, plan, heading_of_camera(marked.front().T), "start", palette::kStart, false);
  }
  plan.draw_axes(canvas);
  draw_legend(canvas, {kLeft, kTop + plan.panel().height + 62}, kWidth - 20, legend_of(view));
  return canvas.image();
}

}  // namespace groundloop::bench
