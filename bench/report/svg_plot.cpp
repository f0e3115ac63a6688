#include "bench/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/report/canvas.h"
#include "bench/report/html.h"

namespace groundloop::bench {
namespace {

constexpr double kWidth = 920, kHeight = 300;
constexpr double kLeft = 62, kRight = 16, kTop = 34, kBottom = 46;
constexpr size_t kMaxPoints = 1600;

/// Linear map from a range of values to SVG units.
struct Axis {
  double low, high, from, to;
  double operator()(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

/// Upper edge of every series: for areas the sum of all areas up to it.
std::vector<std::vector<double>> upper_edges(const Plot& plot) {
  std::vector<std::vector<double>> edges;
  std::vector<double> floor(plot.x.size(), 0);
  for (const PlotSeries& series : plot.series) {
    edges.push_back(series.y);
    if (!series.area) continue;
    for (size_t i = 0; i < floor.size(); ++i) floor[i] += std::isfinite(series.y[i]) ? series.y[i] : 0;
    edges.back() = floor;
  }
  return edges;
}

Axis y_axis(const std::vector<std::vector<double>>& edges, double min_span) {
  double low = 0, high = 0;
  for (const auto& edge : edges) {
    for (const double y : edge) {
      if (!std::isfinite(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  if (low < 0) low = std::min(low, -min_span / 2);
  high = std::max(high, low < 0 ? min_span / 2 : min_span);
  if (high == low) high = 1;
  const double step = nice_step_above((high - low) / 6);
  return {std::floor(low < 0 ? low / step - 0.02 : 0) * step, std::ceil(high / step + 0.02) * step,
          kHeight - kBottom, kTop};
}

Axis x_axis(const std::vector<double>& x) {
  const double low = x.empty() ? 0 : x.front(), high = x.empty() ? 1 : x.back();
  return {low, high > low ? high : low + 1, kLeft, kWidth - kRight};
}

/// Indices to draw. Of a long plot, every stretch keeps the lowest and the highest value of each curve.
std::vector<size_t> kept_points(size_t points, const std::vector<std::vector<double>>& edges) {
  const size_t stretch = points <= kMaxPoints ? 1 : (points * 4 + kMaxPoints - 1) / kMaxPoints;
  std::vector<size_t> kept;
  for (size_t begin = 0; begin < points; begin += stretch) {
    const size_t end = std::min(begin + stretch, points);
    std::vector<size_t> wanted = {begin};
    for (const auto& edge : edges) {
      const auto at = [&](size_t i) { return edge.begin() + static_cast<long>(i); };
      // a missing value is neither the lowest nor the highest
      const auto low = std::min_element(
          at(begin), at(end), [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); });
      const auto high = std::max_element(
          at(begin), at(end), [](double a, double b) { return a < b || (std::isnan(a) && !std::isnan(b)); });
      wanted.push_back(static_cast<size_t>(low - edge.begin()));
      wanted.push_back(static_cast<size_t>(high - edge.begin()));
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    kept.insert(kept.end(), wanted.begin(), wanted.end());
  }
  return kept;
}

/// SVG path through the kept points of a curve; it breaks where a value is missing.
std::string path_of(const std::vector<double>& x, const std::vector<double>& y,
                    const std::vector<size_t>& kept, const Axis& x_of, const Axis& y_of) {
  std::string path;
  bool pen_down = false;
  for (const size_t i : kept) {
    const bool known = std::isfinite(y[i]);
    if (known) path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x_of(x[i]), y_of(y[i]));
    pen_down = known;
  }
  return path;
}

/// Closed path between two edges without gaps.
std::string area_of(const std::vector<double>& x, const std::vector<double>& lower,
                    const std::vector<double>& upper, const std::vector<size_t>& kept, const Axis& x_of,
                    const Axis& y_of) {
  std::string path = path_of(x, upper, kept, x_of, y_of);
  for (const size_t i : std::vector<size_t>(kept.rbegin(), kept.rend())) {
    path += fmt::format("L{:.1f} {:.1f}", x_of(x[i]), y_of(lower[i]));
  }
  return path + "Z";
}

std::string text(double x, double y, const char* anchor, const std::string& content) {
  return fmt::format("<text class=\"svg-text\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y,
                     anchor, escape_html(content));
}

std::string line(const char* css_class, double x1, double y1, double x2, double y2) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                     css_class, x1, y1, x2, y2);
}

std::string grid_and_ticks(const Axis& x_of, const Axis& y_of) {
  std::string svg;
  const double y_step = nice_step_above((y_of.high - y_of.low) / 6 * (1 - 1e-9));
  for (double i = std::ceil(y_of.low / y_step - 1e-9); i * y_step <= y_of.high * (1 + 1e-9); ++i) {
    const double y = y_of(i * y_step);
    svg += line(std::abs(i) < 0.5 ? "svg-axis" : "svg-grid", kLeft, y, kWidth - kRight, y);
    svg += text(kLeft - 8, y + 4, "end", tick_text(i * y_step, y_step));
  }
  const double x_step = nice_step_above((x_of.high - x_of.low) / 10 * (1 - 1e-9));
  for (double i = std::ceil(x_of.low / x_step - 1e-9); i * x_step <= x_of.high * (1 + 1e-9); ++i) {
    const double x = x_of(i * x_step);
    svg += line("svg-axis", x, kHeight - kBottom, x, kHeight - kBottom + 5);
    svg += text(x, kHeight - kBottom + 19, "middle", tick_text(i * x_step, x_step));
  }
  return svg;
}

std::string legend(const Plot& plot) {
  std::string svg;
  double x = kWidth - kRight;
  const auto entry = [&](const std::string& name, const std::string& colour) {
    x -= 7.0 * static_cast<double>(name.size());  // width of a 12-unit sans-serif text, generously
    svg += text(x, 18, "start", name);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"8\" width=\"12\" height=\"12\" rx=\"2\" style=\"fill:{}\"/>",
                       x - 17, colour);
    x -= 34;
  };
  if (!plot.bands.empty()) entry(plot.band_name, "var(--band)");
  for (size_t i = plot.series.size(); i-- > 0;) entry(plot.series[i].name, plot.series[i].colour);
  return svg;
}

}  // namespace

std::string svg_plot(const Plot& plot) {
  const auto edges = upper_edges(plot);
  const Axis x_of = x_axis(plot.x), y_of = y_axis(edges, plot.min_y_span);
  const auto kept = kept_points(plot.x.size(), edges);

  std::string svg = fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                                kWidth, kHeight, escape_html(plot.description));
  for (const auto& [from, to] : plot.bands) {
    svg +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" style=\"fill:var(--band)\"/>",
                    x_of(from), kTop, std::max(1.5, x_of(to) - x_of(from)), kHeight - kBottom - kTop);
  }
  svg += grid_and_ticks(x_of, y_of);
  std::vector<double> floor(plot.x.size(), 0);
  for (size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (series.area) {
      svg += fmt::format("<path d=\"{}\" style=\"fill:{}\"/>",
                         area_of(plot.x, floor, edges[i], kept, x_of, y_of), series.colour);
      floor = edges[i];
    } else {
      svg += fmt::format("<path d=\"{}\" style=\"fill:none;stroke:{};stroke-width:1.6\"/>",
                         path_of(plot.x, edges[i], kept, x_of, y_of), series.colour);
    }
  }
  svg += text(kWidth - kRight, kHeight - 8, "end", plot.x_label) + text(8, 18, "start", plot.y_label);
  return svg + legend(plot) + "</svg>";
}

}  // namespace groundloop::bench
