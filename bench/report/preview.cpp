#include "bench/report/preview.h"

#include <fmt/format.h>

#include <cmath>

#include "bench/report/canvas.h"
#include "bench/report/plan_drawing.h"

namespace groundloop::bench {
namespace {

constexpr int kWidth = 1600;
constexpr double kLeft = 74, kRight = 30, kTop = 22, kBottom = 84;
constexpr double kMaxHeight = 1300;
constexpr Colour kPath(0x1f5fd0), kPathAfter(0x16a0a0), kPerson(0x8a3ab9), kMoved(0xd9730d),
    kKidnapped(0xd6246e);

/// Tip at `at`, which is reached from the direction of `from`.
void draw_arrow_head(Canvas& canvas, cv::Point2d from, cv::Point2d at, Colour colour) {
  constexpr double kLength_px = 13, kHalfWidth_px = 6.5;
  const double length_px = cv::norm(at - from);
  if (length_px == 0) return;
  const cv::Point2d ahead = (at - from) / length_px, aside(-ahead.y, ahead.x);
  canvas.polygon(
      {at, at - ahead * kLength_px + aside * kHalfWidth_px, at - ahead * kLength_px - aside * kHalfWidth_px},
      colour);
}

void draw_dashes(Canvas& canvas, cv::Point2d from, cv::Point2d to, Colour colour) {
  constexpr double kDash_px = 9, kGap_px = 6;
  const double length_px = cv::norm(to - from);
  for (double at_px = 0; at_px < length_px; at_px += kDash_px + kGap_px) {
    const double end_px = std::min(at_px + kDash_px, length_px);
    const cv::Point2d a = from + (to - from) * (at_px / length_px),
                      b = from + (to - from) * (end_px / length_px);
    canvas.line(a, b, palette::kPaper, 5);
    canvas.line(a, b, colour, 2.5);
  }
}

/// An arrow head on the path whenever it went on by this much.
void draw_arrows(Canvas& canvas, const PlanView& view, const std::vector<PlanPose>& path, Colour colour) {
  constexpr double kSpacing_px = 120;
  double since_px = kSpacing_px / 2;
  for (size_t i = 1; i < path.size(); ++i) {
    const cv::Point2d from = view(path[i - 1].x_m, path[i - 1].y_m), to = view(path[i].x_m, path[i].y_m);
    const double step_px = cv::norm(to - from);
    since_px += step_px;
    if (since_px < kSpacing_px || step_px == 0) continue;
    since_px = 0;
    draw_arrow_head(canvas, from, to, colour);
  }
}

/// Where the camera looks, on a path that it does not follow with its eyes.
void draw_looks(Canvas& canvas, const PlanView& view, const std::vector<PlanPose>& path, Colour colour) {
  constexpr double kSpacing_px = 40, kLength_px = 18, kAside_rad = 0.2;
  double since_px = kSpacing_px;
  for (size_t i = 1; i < path.size(); ++i) {
    const cv::Point2d step = view(path[i].x_m, path[i].y_m) - view(path[i - 1].x_m, path[i - 1].y_m);
    since_px += cv::norm(step);
    const double way_rad = std::atan2(-step.y, step.x);  // y of a picture points down
    const double aside_rad = std::abs(std::remainder(path[i].yaw_rad - way_rad, 2 * M_PI));
    if (since_px < kSpacing_px || cv::norm(step) == 0 || aside_rad < kAside_rad) continue;
    since_px = 0;
    draw_heading(canvas, view, path[i], kLength_px, colour);
  }
}

void draw_leg(Canvas& canvas, const PlanView& view, const std::vector<PlanPose>& path, Colour colour) {
  std::vector<cv::Point2d> points;
  points.reserve(path.size());
  for (const PlanPose& pose : path) points.push_back(view(pose.x_m, pose.y_m));
  canvas.polyline(points, palette::kPaper, 7);
  canvas.polyline(points, colour, 3);
  draw_arrows(canvas, view, path, colour);
  draw_looks(canvas, view, path, colour);
}

void draw_walk(Canvas& canvas, const PlanView& view, const DrawnWalk& walk) {
  std::vector<cv::Point2d> corners;
  for (const auto& p : walk.way) corners.push_back(view(p));
  for (size_t i = 1; i < corners.size(); ++i) draw_dashes(canvas, corners[i - 1], corners[i], kPerson);
  if (corners.size() > 1) draw_arrow_head(canvas, corners[corners.size() - 2], corners.back(), kPerson);
  if (corners.size() > 1 && walk.back_and_forth) draw_arrow_head(canvas, corners[1], corners[0], kPerson);
  canvas.disc(corners.front(), 7, palette::kPaper);
  canvas.disc(corners.front(), 5, kPerson);
  canvas.label({corners.front().x + 12, corners.front().y - 8}, walk.name, 11, kPerson);
}

Bounds bounds_of(const std::vector<Footprint>& outline) {
  Bounds bounds;
  for (const Footprint& footprint : outline) {
    for (const auto& p : footprint.polygon) bounds.add(p);
  }
  return bounds;
}

void draw_move(Canvas& canvas, const PlanView& view, const DrawnMove& move) {
  for (const auto& [things, alpha] : {std::pair(&move.from, 0.0), std::pair(&move.to, 0.35)}) {
    for (const Footprint& thing : *things) {
      std::vector<cv::Point2d> corners;
      for (const auto& p : thing.polygon) corners.push_back(view(p));
      if (alpha > 0) canvas.polygon(corners, kMoved, alpha);
      canvas.polyline(corners, kMoved, 1.5, true);
    }
  }
  const Bounds from = bounds_of(move.from), to = bounds_of(move.to);
  const cv::Point2d a = view(Eigen::Vector2d((from.min + from.max) / 2)),
                    b = view(Eigen::Vector2d((to.min + to.max) / 2));
  draw_dashes(canvas, a, b, kMoved);
  draw_arrow_head(canvas, a, b, kMoved);
  const cv::Point2d beside = view(to.max);
  canvas.label({beside.x + 5, beside.y + 4}, fmt::format("{:g} s", move.at_s), 11, kMoved);
}

void draw_kidnapping(Canvas& canvas, const PlanView& view, const DrawnKidnapping& kidnapping) {
  const PlanPose& down = kidnapping.path.front();
  const cv::Point2d a = view(kidnapping.from.x_m, kidnapping.from.y_m), b = view(down.x_m, down.y_m);
  draw_dashes(canvas, a, b, kKidnapped);
  draw_arrow_head(canvas, a, b, kKidnapped);
  canvas.disc(a, 6, palette::kPaper);
  canvas.disc(a, 4, kKidnapped);
  // to the left of the arrow
  const cv::Point2d middle = (a + b) / 2, ahead = (b - a) / std::max(1.0, cv::norm(b - a));
  const cv::Point2d at = middle + cv::Point2d(ahead.y, -ahead.x) * 14;
  canvas.label({at.x, at.y + 5}, fmt::format("carried off at {:g} s", kidnapping.at_s), 11, kKidnapped,
               at.x < middle.x ? Align::kRight : Align::kLeft);
}

std::vector<LegendItem> legend_of(const DrawnEvents& events) {
  using Mark = LegendItem::Mark;
  std::vector<LegendItem> items = {{Mark::kLine, kPath, "planned trajectory"},
                                   {Mark::kBox, palette::kThing, "scene"}};
  if (!events.people.empty()) items.push_back({Mark::kLine, kPerson, "person's way"});
  if (!events.moves.empty()) items.push_back({Mark::kBox, kMoved, "furniture put there, and when"});
  if (!events.kidnappings.empty()) {
    items.push_back({Mark::kLine, kKidnapped, "robot carried off"});
    items.push_back({Mark::kLine, kPathAfter, "plan from there on"});
  }
  return items;
}

/// Of everything that is drawn.
Bounds bounds_of(const std::vector<Footprint>& outline, const std::vector<PlanPose>& path,
                 const PlanPose& start, const DrawnEvents& events) {
  Bounds bounds = bounds_of(outline);
  bounds.add({start.x_m, start.y_m});
  for (const PlanPose& pose : path) bounds.add({pose.x_m, pose.y_m});
  for (const DrawnKidnapping& kidnapping : events.kidnappings) {
    for (const PlanPose& pose : kidnapping.path) bounds.add({pose.x_m, pose.y_m});
  }
  for (const DrawnWalk& walk : events.people) {
    for (const auto& p : walk.way) bounds.add(p);
  }
  for (const DrawnMove& move : events.moves) {
    const Bounds there = bounds_of(move.to);
    bounds.add(there.min);
    bounds.add(there.max);
  }
  return bounds;
}

}  // namespace

cv::Mat draw_preview(const std::vector<Footprint>& outline, const std::vector<PlanPose>& path,
                     const PlanPose& start, const DrawnEvents& events) {
  const Bounds bounds = bounds_of(outline, path, start, events);
  const PlanView view(bounds.grown(std::max(0.3, 0.02 * bounds.size().maxCoeff())), {kLeft, kTop},
                      kWidth - kLeft - kRight, kMaxHeight);
  Canvas canvas(kWidth, cvRound(kTop + view.panel().height + kBottom), palette::kPaper);
  view.draw_grid(canvas, palette::kGrid);
  draw_outline(canvas, view, outline, true);

  for (const DrawnMove& move : events.moves) draw_move(canvas, view, move);
  // the first leg last: where both lead along the same line, it is the one that is looked for
  for (const DrawnKidnapping& kidnapping : events.kidnappings) {
    draw_leg(canvas, view, kidnapping.path, kPathAfter);
  }
  draw_leg(canvas, view, path, kPath);
  for (const DrawnKidnapping& kidnapping : events.kidnappings) draw_kidnapping(canvas, view, kidnapping);
  for (const DrawnWalk& walk : events.people) draw_walk(canvas, view, walk);
  const std::vector<PlanPose>& last = events.kidnappings.empty() ? path : events.kidnappings.back().path;
  if (!last.empty()) draw_place(canvas, view, last.back(), "end", palette::kEnd, true);
  const cv::Point2d at = view(start.x_m, start.y_m);
  canvas.line(at, at + cv::Point2d(std::cos(start.yaw_rad), -std::sin(start.yaw_rad)) * 34, palette::kStart,
              4);
  draw_place(canvas, view, start, "start", palette::kStart, false);

  view.draw_axes(canvas);
  draw_legend(canvas, {kLeft, kTop + view.panel().height + 62}, kWidth - 20, legend_of(events));
  return canvas.image();
}

}  // namespace groundloop::bench
