#include "bench/report/plan_drawing.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace groundloop::bench {
namespace {

double area_m2(const Footprint& footprint) {
  double twice = 0;
  for (size_t i = 0; i < footprint.polygon.size(); ++i) {
    const auto& a = footprint.polygon[i];
    const auto& b = footprint.polygon[(i + 1) % footprint.polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

/// The simulator calls a part without a name "geom 46 (body north_desk)"; a reader wants "north desk".
std::string shown_name(const std::string& name) {
  const std::string before = "(body ";
  const size_t body = name.find(before);
  std::string shown = body == std::string::npos ? name : name.substr(body + before.size());
  if (body != std::string::npos && shown.ends_with(')')) shown.pop_back();
  std::replace(shown.begin(), shown.end(), '_', ' ');
  return shown;
}

/// True when the name fits into the footprint and was written.
bool draw_name(Canvas& canvas, const PlanView& view, const Footprint& footprint, const std::string& name) {
  constexpr double kSize = 9;
  Bounds bounds;
  for (const auto& p : footprint.polygon) bounds.add(p);
  const Eigen::Vector2d size_px = bounds.size() * view.px_per_m();
  if (Canvas::text_width(name, kSize) + 8 > size_px.x() || size_px.y() < kSize + 8) return false;
  const cv::Point2d centre = view(Eigen::Vector2d((bounds.min + bounds.max) / 2));
  canvas.label({centre.x, centre.y + kSize / 2}, name, kSize, palette::kSoftInk, Align::kCentre);
  return true;
}

}  // namespace

PlanPose heading_of_camera(const slam::Pose& T_frame_left) {
  const Eigen::Vector3d axis = T_frame_left.linear().col(2);
  return {T_frame_left.translation().x(), T_frame_left.translation().y(), std::atan2(axis.y(), axis.x())};
}

void draw_outline(Canvas& canvas, const PlanView& view, std::vector<Footprint> outline, bool with_names) {
  std::stable_sort(outline.begin(), outline.end(),
                   [](const Footprint& a, const Footprint& b) { return area_m2(a) > area_m2(b); });
  for (const Footprint& footprint : outline) {
    std::vector<cv::Point2d> corners;
    for (const auto& p : footprint.polygon) corners.push_back(view(p));
    canvas.polygon(corners, palette::kThing, 0.75);
    canvas.polyline(corners, palette::kThingEdge, 1, true);
  }
  if (!with_names) return;
  std::set<std::string> written;  // each name once, on its largest part
  for (const Footprint& footprint : outline) {
    const std::string name = shown_name(footprint.name);
    if (!written.contains(name) && draw_name(canvas, view, footprint, name)) written.insert(name);
  }
}

void draw_heading(Canvas& canvas, const PlanView& view, const PlanPose& pose, double length_px,
                  Colour colour) {
  const cv::Point2d at = view(pose.x_m, pose.y_m);
  const cv::Point2d tip =
      at + cv::Point2d(std::cos(pose.yaw_rad) * length_px, -std::sin(pose.yaw_rad) * length_px);
  canvas.disc(at, 4.5, palette::kPaper);
  canvas.line(at, tip, colour, 1.5);
  canvas.disc(at, 3.5, colour);
}

void draw_path(Canvas& canvas, const PlanView& view, const slam::Trajectory& trajectory, Colour colour,
               double width) {
  std::vector<cv::Point2d> points;
  for (const auto& pose : trajectory) points.push_back(view(pose.T.translation().head<2>()));
  canvas.polyline(points, colour, width);
}

void draw_place(Canvas& canvas, const PlanView& view, const PlanPose& pose, const std::string& name,
                Colour colour, bool name_below) {
  const cv::Point2d at = view(pose.x_m, pose.y_m);
  canvas.disc(at, 9, palette::kPaper);
  canvas.circle(at, 9, colour, 3);
  canvas.disc(at, 4, colour);
  canvas.label({at.x + 16, at.y + (name_below ? 23 : -10)}, name, 13, colour);
}

}  // namespace groundloop::bench
