#pragma once

#include <string>
#include <utility>
#include <vector>

namespace groundloop::bench {

/// One curve, or one layer of a stack. NaN leaves a gap.
struct PlotSeries {
  std::string name;
  std::string colour;     ///< CSS colour; a variable such as var(--s1) follows the page's light or dark theme
  std::vector<double> y;  ///< as many as the plot's x
  bool area = false;      ///< fills down to the layer below; layers stand on each other in their order
};

struct Plot {
  std::string description;  ///< for readers who cannot see it
  std::string x_label;
  std::string y_label;
  std::vector<double> x;  ///< rising
  std::vector<PlotSeries> series;
  std::vector<std::pair<double, double>> bands;  ///< spans of x with a red ground, as lost frames
  std::string band_name;
  double min_y_span = 0;  ///< smallest range of y to show, so that rounding noise does not fill the plot
};

/// A plot as inline SVG, 920 x 300 units, that scales with the page. Its text and lines take the page's
/// colours by the CSS classes svg-text, svg-grid and svg-axis. Long curves are thinned so that peaks stay.
std::string svg_plot(const Plot& plot);

}  // namespace groundloop::bench
