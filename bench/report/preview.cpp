#include "bench/report/preview.h"

#include <cmath>

#include "bench/report/canvas.h"
#include "bench/report/plan_drawing.h"

namespace groundloop::bench {
namespace {

constexpr int kWidth = 1600;
constexpr double kLeft = 74, kRight = 30, kTop = 22, kBottom = 84;
constexpr double kMaxHeight = 1300;
constexpr Colour kPath(0x1f5fd0);

/// An arrow head on the path whenever it went on by this much.
void draw_arrows(Canvas& canvas, const PlanView& view, const std::vector<PlanPose>& path) {
  constexpr double kSpacing_px = 120, kLength_px = 13, kHalfWidth_px = 6.5;
  double since_px = kSpacing_px / 2;
  for (size_t i = 1; i < path.size(); ++i) {
    const cv::Point2d from = view(path[i - 1].x_m, path[i - 1].y_m), to = view(path[i].x_m, path[i].y_m);
    const double step_px = cv::norm(to - from);
    since_px += step_px;
    if (since_px < kSpacing_px || step_px == 0) continue;
    since_px = 0;
    const cv::Point2d ahead = (to - from) / step_px, aside(-ahead.y, ahead.x);
    canvas.polygon({to + ahead * kLength_px / 2, to - ahead * kLength_px / 2 + aside * kHalfWidth_px,
                    to - ahead * kLength_px / 2 - aside * kHalfWidth_px},
                   kPath);
  }
}

/// Where the camera looks, on a path that it does not follow with its eyes.
void draw_looks(Canvas& canvas, const PlanView& view, const std::vector<PlanPose>& path) {
  constexpr double kSpacing_px = 40, kLength_px = 18, kAside_rad = 0.2;
  double since_px = kSpacing_px;
  for (size_t i = 1; i < path.size(); ++i) {
    const cv::Point2d step = view(path[i].x_m, path[i].y_m) - view(path[i - 1].x_m, path[i - 1].y_m);
    since_px += cv::norm(step);
    const double way_rad = std::atan2(-step.y, step.x);  // y of a picture points down
    const double aside_rad = std::abs(std::remainder(path[i].yaw_rad - way_rad, 2 * M_PI));
    if (since_px < kSpacing_px || cv::norm(step) == 0 || aside_rad < kAside_rad) continue;
    since_px = 0;
    draw_heading(canvas, view, path[i], kLength_px, kPath);
  }
}

}  // namespace

cv::Mat draw_preview(const std::vector<Footprint>& outline, const std::vector<PlanPose>& path,
                     const PlanPose& start) {
  Bounds bounds;
  bounds.add({start.x_m, start.y_m});
  for (const PlanPose& pose : path) bounds.add({pose.x_m, pose.y_m});
  for (const Footprint& footprint : outline) {
    for (const auto& p : footprint.polygon) bounds.add(p);
  }
  const PlanView view(bounds.grown(std::max(0.3, 0.02 * bounds.size().maxCoeff())), {kLeft, kTop},
                      kWidth - kLeft - kRight, kMaxHeight);
  Canvas canvas(kWidth, cvRound(kTop + view.panel().height + kBottom), palette::kPaper);
  view.draw_grid(canvas, palette::kGrid);
  draw_outline(canvas, view, outline, true);

  std::vector<cv::Point2d> points;
  points.reserve(path.size());
  for (const PlanPose& pose : path) points.push_back(view(pose.x_m, pose.y_m));
  canvas.polyline(points, palette::kPaper, 7);
  canvas.polyline(points, kPath, 3);
  draw_arrows(canvas, view, path);
  draw_looks(canvas, view, path);
  if (!path.empty()) draw_place(canvas, view, path.back(), "end", palette::kEnd, true);
  const cv::Point2d at = view(start.x_m, start.y_m);
  canvas.line(at, at + cv::Point2d(std::cos(start.yaw_rad), -std::sin(start.yaw_rad)) * 34, palette::kStart,
              4);
  draw_place(canvas, view, start, "start", palette::kStart, false);

  view.draw_axes(canvas);
  using Mark = LegendItem::Mark;
  draw_legend(canvas, {kLeft, kTop + view.panel().height + 62}, kWidth - 20,
              {{Mark::kLine, kPath, "planned trajectory"}, {Mark::kBox, palette::kThing, "scene"}});
  return canvas.image();
}

}  // namespace groundloop::bench
