#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "bench/report/canvas.h"
#include "bench/report/figures.h"

namespace groundloop::bench {
namespace {

using slam::GridGeometry;
using slam::OccupancyMap;

constexpr int kWidth = 1600;
constexpr double kLeft = 74, kRight = 26, kTop = 52, kBottom = 84, kMaxHeight = 1300;
constexpr Colour kFreeColour(0xf2f7fd);
constexpr Colour kUnknownColour(0xb9c1cb);
constexpr Colour kOccupiedColour(0x16202c);
constexpr Colour kHiddenOccupiedColour(0x808b98);
constexpr Colour kMapGrid(0xd5dde7);

enum class Cell { kFree, kUnknown, kOccupied };

Cell cell_of(float value) {
  return value > OccupancyMap::kOccupiedAbove ? Cell::kOccupied
         : value < OccupancyMap::kFreeBelow   ? Cell::kFree
                                              : Cell::kUnknown;
}

Bounds bounds_of(const GridGeometry& g) {
  return {{g.x_min_m, g.y_min_m}, {g.x_min_m + g.cols * g.cell_m, g.y_min_m + g.rows * g.cell_m}};
}

/// Bounds of the known cells, for a map that stands alone.
Bounds known_bounds(const OccupancyMap& map) {
  Bounds bounds;
  for (int row = 0; row < map.geometry.rows; ++row) {
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (cell_of(map.at(col, row)) != Cell::kUnknown) bounds.add(map.geometry.centre_m(col, row));
    }
  }
  return bounds.empty() ? bounds_of(map.geometry) : bounds.grown(0.5);
}

/// How a cell is drawn: free ground below the grid lines, everything else above.
struct CellPaint {
  Colour colour;
  bool above_grid = true;
};

Colour mixed(Colour from, Colour to, float part) {
  uint32_t rgb = 0;
  for (int shift = 0; shift <= 16; shift += 8) {
    const auto a = static_cast<float>(from.rgb >> shift & 0xff),
               b = static_cast<float>(to.rgb >> shift & 0xff);
    rgb |= static_cast<uint32_t>(std::lround(a + part * (b - a))) << shift;
  }
  return Colour(rgb);
}

/// Decided cells have the full colour; an undecided one leans towards what it would become, up to half way.
CellPaint paint_of(float value) {
  const Cell cell = cell_of(value);
  if (cell == Cell::kFree) return {kFreeColour, false};
  if (cell == Cell::kOccupied) return {kOccupiedColour};
  const float lean =
      (value - OccupancyMap::kUnknown) / (OccupancyMap::kOccupiedAbove - OccupancyMap::kUnknown);
  return {mixed(kUnknownColour, lean > 0 ? kOccupiedColour : kFreeColour, std::abs(lean) / 2)};
}

/// Gives every pixel of the panel the colour of its cell; `paint_at` gets col and row of a cell.
template <class PaintAt>
void paint_cells(Canvas& canvas, const PlanView& view, const GridGeometry& geometry, bool above_grid,
                 const PaintAt& paint_at) {
  const cv::Rect2d panel = view.panel();
  constexpr int kScale = Canvas::kScale;
  const int left = cvCeil(panel.x * kScale);
  std::vector<int> col_of;  // of each pixel across: the same in all rows
  for (int u = left; u < panel.br().x * kScale; ++u) {
    col_of.push_back(geometry.col_of(view.metres((u + 0.5) / kScale, 0).x()));
  }
  for (int v = cvCeil(panel.y * kScale); v < panel.br().y * kScale; ++v) {
    const int row = geometry.row_of(view.metres(0, (v + 0.5) / kScale).y());
    auto* pixel = canvas.pixels().ptr<cv::Vec3b>(v, left);
    for (const int col : col_of) {
      const CellPaint paint = geometry.contains(col, row) ? paint_at(col, row) : CellPaint{kUnknownColour};
      if (paint.above_grid == above_grid) *pixel = paint.colour.bgr();
      ++pixel;
    }
  }
}

template <class PaintAt>
void draw_map(Canvas& canvas, const PlanView& view, const GridGeometry& geometry, const std::string& title,
              const PaintAt& paint_at) {
  paint_cells(canvas, view, geometry, false, paint_at);
  view.draw_grid(canvas, kMapGrid);
  paint_cells(canvas, view, geometry, true, paint_at);
  view.draw_axes(canvas);
  canvas.text({view.panel().x, view.panel().y - 16}, title, 14, palette::kInk);
}

std::vector<LegendItem> map_legend(bool with_hidden) {
  using Mark = LegendItem::Mark;
  std::vector<LegendItem> items = {{Mark::kBox, kFreeColour, "free"},
                                   {Mark::kBox, kOccupiedColour, "occupied"}};
  items.push_back({Mark::kBox, kUnknownColour, with_hidden ? "unknown or not visible" : "unknown"});
  if (with_hidden) items.push_back({Mark::kBox, kHiddenOccupiedColour, "occupied, but not visible"});
  return items;
}

enum Difference { kRightFree, kRightOccupied, kFalseOccupied, kFalseFree, kMissed, kNotSeen, kDifferences };

struct DifferenceStyle {
  Colour colour;
  const char* text;
};
constexpr std::array<DifferenceStyle, kDifferences> kDifferenceStyles = {
    {{Colour(0xeaf3ec), "right, free"},
     {Colour(0x1f7a4d), "right, occupied"},
     {Colour(0xe0334a), "false occupied"},
     {Colour(0xf39c12), "false free"},
     {Colour(0x7fa8e8), "missed (unknown)"},
     {kUnknownColour, "not seen"}}};

Difference difference_of(float estimate, float exact, bool visible) {
  if (!visible) return kNotSeen;
  const bool occupied = cell_of(exact) == Cell::kOccupied;
  switch (cell_of(estimate)) {
    case Cell::kFree:
      return occupied ? kFalseFree : kRightFree;
    case Cell::kOccupied:
      return occupied ? kRightOccupied : kFalseOccupied;
    case Cell::kUnknown:
      break;
  }
  return kMissed;
}

}  // namespace

OccupancyMap resampled_map(const OccupancyMap& map, const slam::Pose& T_world_map,
                           const GridGeometry& geometry) {
  OccupancyMap result{geometry, std::vector<float>(geometry.cells(), OccupancyMap::kUnknown)};
  const double yaw_rad = slam::yaw_rad(T_world_map.linear());
  const Eigen::Rotation2Dd R_map_world(-yaw_rad);
  const Eigen::Vector2d p_world_map = T_world_map.translation().head<2>();
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      const Eigen::Vector2d p_map = R_map_world * (geometry.centre_m(col, row) - p_world_map);
      result.value[geometry.index(col, row)] = map.at_point(p_map.x(), p_map.y());
    }
  }
  return result;
}

cv::Mat draw_map_pair(const OccupancyMap& estimate, const std::optional<OccupancyMap>& exact,
                      const std::vector<uint8_t>& visible) {
  constexpr double kGap = 84;
  const Bounds bounds = exact ? bounds_of(exact->geometry).grown(0.3) : known_bounds(estimate);
  const double width = exact ? (kWidth - kLeft - kRight - kGap) / 2 : kWidth - kLeft - kRight;
  const PlanView left(bounds, {kLeft, kTop}, width, kMaxHeight);
  Canvas canvas(kWidth, cvRound(kTop + left.panel().height + kBottom), palette::kPaper);
  draw_map(canvas, left, estimate.geometry, "estimated map",
           [&](int col, int row) { return paint_of(estimate.at(col, row)); });
  if (exact) {
    const PlanView right(bounds, {kLeft + width + kGap, kTop}, width, kMaxHeight);
    draw_map(canvas, right, exact->geometry, "exact map", [&](int col, int row) {
      const float value = exact->at(col, row);
      if (visible.empty() || visible[exact->geometry.index(col, row)] != 0) return paint_of(value);
      return CellPaint{cell_of(value) == Cell::kOccupied ? kHiddenOccupiedColour : kUnknownColour};
    });
  }
  draw_legend(canvas, {kLeft, kTop + left.panel().height + 62}, kWidth - 20, map_legend(!visible.empty()));
  return canvas.image();
}

cv::Mat draw_map_difference(const OccupancyMap& estimate, const OccupancyMap& exact,
                            const std::vector<uint8_t>& visible) {
  const GridGeometry& g = exact.geometry;
  if (estimate.geometry.cols != g.cols || estimate.geometry.rows != g.rows || visible.size() != g.cells()) {
    throw std::invalid_argument("draw_map_difference: maps and visibility differ in size");
  }
  std::vector<Difference> difference(g.cells());
  std::array<int, kDifferences> cells{};
  for (size_t i = 0; i < g.cells(); ++i) {
    difference[i] = difference_of(estimate.value[i], exact.value[i], visible[i] != 0);
    ++cells[difference[i]];
  }
  const PlanView view(bounds_of(g).grown(0.3), {kLeft, kTop}, kWidth - kLeft - kRight, kMaxHeight);
  Canvas canvas(kWidth, cvRound(kTop + view.panel().height + kBottom), palette::kPaper);
  draw_map(canvas, view, g, "estimated against exact", [&](int col, int row) {
    const Difference kind = difference[g.index(col, row)];
    return CellPaint{kDifferenceStyles[kind].colour, kind != kRightFree};
  });
  std::vector<LegendItem> legend;
  for (int kind = 0; kind < kDifferences; ++kind) {
    const auto& [colour, text] = kDifferenceStyles[static_cast<size_t>(kind)];
    const double area_m2 = cells[static_cast<size_t>(kind)] * g.cell_m * g.cell_m;
    legend.push_back({LegendItem::Mark::kBox, colour, fmt::format("{} {:.1f} m2", text, area_m2)});
  }
  draw_legend(canvas, {kLeft, kTop + view.panel().height + 62}, kWidth - 20, legend);
  return canvas.image();
}

}  // namespace groundloop::bench
