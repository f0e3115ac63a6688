#include "sim/head/optics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

constexpr int kMargin_px = 2;      ///< rendered beyond the outermost footprint
constexpr double kGaussReach = 4;  ///< standard deviations that a blur may reach

Vector2d direction(const Lens& lens, const Vector2d& uv_px, const Vector2d& near) {
  const auto xy = lens.direction(uv_px, near);
  if (!xy) throw std::domain_error("a distortion that folds over inside the image");
  return *xy;
}

/// Corners of the footprints along one axis, in order.
std::vector<double> edges_of(const std::vector<Extent>& extents) {
  std::vector<double> edges;
  for (const Extent& extent : extents) {
    edges.push_back(extent.from);
    edges.push_back(extent.to);
  }
  return edges;
}

struct Bounds {
  Vector2d low = Vector2d::Constant(INFINITY), high = Vector2d::Constant(-INFINITY);

  void add(const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Directions along the outline of the image.
void add_outline(const Lens& lens, const ReadPixels& pixels, Bounds& bounds) {
  const std::vector<double> us = edges_of(pixels.columns), vs = edges_of(pixels.rows);
  const auto add_line = [&](const std::vector<double>& along, auto point) {
    Vector2d near = Vector2d::Zero();
    for (const double at : along) {
      near = direction(lens, point(at), near);
      bounds.add(near);
    }
  };
  for (const double v : {vs.front(), vs.back()}) add_line(us, [v](double u) { return Vector2d(u, v); });
  for (const double u : {us.front(), us.back()}) add_line(vs, [u](double v) { return Vector2d(u, v); });
}

double vignetting_at(const Optics& optics, const Lens& lens, const ReadPixels& pixels, const Vector2d& uv_px,
                     const Vector2d& xy) {
  const double cosine = 1 / std::sqrt(1 + xy.squaredNorm());
  const double half_diagonal_px = 0.5 * std::hypot(pixels.columns.back().to - pixels.columns.front().from,
                                                   pixels.rows.back().to - pixels.rows.front().from);
  const double r2 = ((uv_px - Vector2d(lens.cx_px, lens.cy_px)) / half_diagonal_px).squaredNorm();
  const Vignetting& law = optics.vignetting;
  return std::max(0.0, std::pow(cosine, law.cosine_power) * (1 + r2 * (law.a2 + r2 * law.a4)));
}

}  // namespace

cv::Mat disk_kernel(double radius_px) {
  constexpr int kFine = 16;
  const int reach = static_cast<int>(std::ceil(radius_px));
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32FC1);
  for (int v = 0; v < kernel.rows * kFine; ++v) {
    for (int u = 0; u < kernel.cols * kFine; ++u) {
      const double x = (u + 0.5) / kFine - 0.5 - reach, y = (v + 0.5) / kFine - 0.5 - reach;
      if (std::hypot(x, y) <= radius_px) kernel.at<float>(v / kFine, u / kFine) += 1;
    }
  }
  return kernel / cv::sum(kernel)[0];
}

RenderView render_view(const Optics& optics, const ReadPixels& pixels) {
  Bounds bounds;
  for (const Lens* lens : {&optics.left, &optics.right}) add_outline(*lens, pixels, bounds);
  RenderView view;
  view.focal_px = optics.supersampling *
                  std::max({optics.left.fx_px, optics.left.fy_px, optics.right.fx_px, optics.right.fy_px});
  const double reach_px =
      kMargin_px + optics.supersampling * (kGaussReach * optics.blur_px + optics.defocus_px);
  const auto pixels_of = [&](double extent) {
    return static_cast<int>(std::ceil(extent * view.focal_px + 2 * reach_px));
  };
  view.size = {pixels_of(bounds.high.x() - bounds.low.x()), pixels_of(bounds.high.y() - bounds.low.y())};
  view.cx_px = reach_px - 0.5 - bounds.low.x() * view.focal_px;
  view.cy_px = reach_px - 0.5 - bounds.low.y() * view.focal_px;
  return view;
}

LensImage::LensImage(const Optics& optics, int camera, const ReadPixels& pixels, const RenderView& view)
    : size_(pixels.size()),
      blur_px_(optics.supersampling * optics.blur_px),
      disk_(optics.defocus_px > 0 ? disk_kernel(optics.supersampling * optics.defocus_px) : cv::Mat()),
      table_(view.size) {
  const Lens& lens = optics.lens(camera);
  const std::vector<double> us = edges_of(pixels.columns), vs = edges_of(pixels.rows);
  // directions of all corners on two rows at a time: upper and lower edges of one row of pixels
  std::vector<Vector2d> upper(us.size()), lower(us.size());
  const auto see = [&](double v, std::vector<Vector2d>& line) {
    Vector2d near = line.front();
    for (size_t i = 0; i < us.size(); ++i) line[i] = near = direction(lens, {us[i], v}, near);
  };
  std::fill(upper.begin(), upper.end(), Vector2d(Vector2d::Zero()));
  std::fill(lower.begin(), lower.end(), Vector2d(Vector2d::Zero()));
  const Vector2d centre_px(view.cx_px, view.cy_px);
  for (int row = 0; row < size_.height; ++row) {
    see(vs[2 * static_cast<size_t>(row)], upper);
    see(vs[2 * static_cast<size_t>(row) + 1], lower);
    for (int col = 0; col < size_.width; ++col) {
      const size_t i = 2 * static_cast<size_t>(col);
      Footprint footprint = {upper[i], upper[i + 1], lower[i + 1], lower[i]};
      const Vector2d xy = 0.25 * (footprint[0] + footprint[1] + footprint[2] + footprint[3]);
      for (Vector2d& corner : footprint) corner = view.focal_px * corner + centre_px;
      table_.add(footprint, channel_of(pixels.mosaic, row, col));
      const Vector2d uv_px(0.5 * (us[i] + us[i + 1]),
                           0.5 * (vs[2 * static_cast<size_t>(row)] + vs[2 * static_cast<size_t>(row) + 1]));
      vignetting_.push_back(static_cast<float>(vignetting_at(optics, lens, pixels, uv_px, xy)));
    }
  }
}

void LensImage::expose(const cv::Mat& rendered, cv::Mat& level) const {
  cv::Mat light = rendered;
  if (blur_px_ > 0) {
    cv::Mat blurred;
    cv::GaussianBlur(light, blurred, {}, blur_px_, 0, cv::BORDER_REPLICATE);
    light = blurred;
  }
  if (!disk_.empty()) {
    cv::Mat defocused;
    cv::filter2D(light, defocused, -1, disk_, {-1, -1}, 0, cv::BORDER_REPLICATE);
    light = defocused;
  }
  level.create(size_, CV_32FC1);
  table_.apply(light, vignetting_, level);
}

}  // namespace groundloop::sim
