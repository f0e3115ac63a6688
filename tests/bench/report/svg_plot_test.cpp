#include "bench/report/svg_plot.h"

#include <gmock/gmock.h>

#include <limits>

namespace groundloop::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The paths of a plot, in order.
std::vector<std::string> paths(const std::string& svg) {
  std::vector<std::string> found;
  const std::string open = "<path d=\"";
  for (size_t at = svg.find(open); at != std::string::npos; at = svg.find(open, at)) {
    at += open.size();
    found.push_back(svg.substr(at, svg.find('"', at) - at));
  }
  return found;
}

Plot plot_of(std::vector<double> x, std::vector<PlotSeries> series) {
  return {.description = "d",
          .x_label = "x",
          .y_label = "y",
          .x = std::move(x),
          .series = std::move(series),
          .bands = {},
          .band_name = ""};
}

TEST(SvgPlot, DrawsValuesAtTheirTicks) {
  // 0 .. 60 in steps of 10 lies between y = 254 (bottom) and the first nice number above 60
  const std::string svg = svg_plot(plot_of({0, 5, 10}, {{"a", "red", {0, 60, 30}}}));
  ASSERT_EQ(paths(svg).size(), 1U);
  // axis ends at 70: 254 - 220 * 60 / 70 and 254 - 220 * 30 / 70; x from 62 to 904
  EXPECT_EQ(paths(svg)[0], "M62.0 254.0L483.0 65.4L904.0 159.7");
  EXPECT_THAT(svg, HasSubstr("y=\"69.4\" text-anchor=\"end\">60</text>"));
}

TEST(SvgPlot, BreaksTheCurveWhereAValueIsMissing) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto found = paths(svg_plot(plot_of({0, 1, 2, 3, 4}, {{"a", "red", {1, 2, none, 2, 1}}})));
  EXPECT_EQ(std::count(found[0].begin(), found[0].end(), 'M'), 2);
  EXPECT_EQ(std::count(found[0].begin(), found[0].end(), 'L'), 2);
}

TEST(SvgPlot, StacksAreas) {
  const auto found =
      paths(svg_plot(plot_of({0, 10}, {{"a", "red", {10, 10}, true}, {"b", "blue", {20, 50}, true}})));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], "M62.0 222.6L904.0 222.6L904.0 254.0L62.0 254.0Z");
  EXPECT_EQ(found[1], "M62.0 159.7L904.0 65.4L904.0 222.6L62.0 222.6Z");
}

TEST(SvgPlot, ThinsLongCurvesButKeepsThePeak) {
  std::vector<double> x, y;
  for (int i = 0; i < 100'000; ++i) {
    x.push_back(i);
    y.push_back(i == 77'777 ? 60 : 10);
  }
  const auto found = paths(svg_plot(plot_of(x, {{"a", "red", y}})));
  EXPECT_LT(found[0].size(), 40'000U);
  EXPECT_THAT(found[0], HasSubstr(" 65.4L"));
}

TEST(SvgPlot, EscapesNamesAndMarksBands) {
  Plot plot = plot_of({0, 10}, {{"<a>", "red", {0, 1}}});
  plot.description = "a \"quoted\" one";
  plot.bands = {{5, 10}};
  plot.band_name = "lost";
  const std::string svg = svg_plot(plot);
  EXPECT_THAT(svg, HasSubstr("aria-label=\"a &quot;quoted&quot; one\""));
  EXPECT_THAT(svg, HasSubstr("&lt;a&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("<a>")));
  EXPECT_THAT(svg, HasSubstr("<rect x=\"483.0\" y=\"34\" width=\"421.0\""));
}

TEST(SvgPlot, DoesNotMagnifyRoundingNoise) {
  Plot plot = plot_of({0, 10}, {{"a", "red", {1e-13, -1e-13}}});
  plot.min_y_span = 0.2;
  EXPECT_THAT(svg_plot(plot), HasSubstr(">0.10</text>"));
}

TEST(SvgPlot, AnEmptyPlotIsStillAPlot) {
  EXPECT_THAT(svg_plot(plot_of({}, {{"a", "red", {}}})), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace groundloop::bench
