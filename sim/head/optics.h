#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "sim/head/area_table.h"
#include "sim/head/lens.h"
#include "sim/head/pixel_grid.h"

namespace groundloop::sim {

/// How much less light reaches the image towards its corners: cos(theta)^n times 1 + a2 r^2 + a4 r^4, theta
/// from the optical axis, r from the principal point in units of half the image's diagonal.
struct Vignetting {
  double cosine_power = 4;  ///< 4: the natural law; 0: none
  double a2 = 0;
  double a4 = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("cosine_power", cosine_power, {.min = 0, .max = 8});
    a("a2", a2, {.min = -1, .max = 1});
    a("a4", a4, {.min = -1, .max = 1});
  }
};

/// The lenses of a head, and how their images are made from rendered pinhole images.
struct Optics {
  Lens left, right;
  double blur_px = 0;     ///< standard deviation of the lens' point image, Gaussian
  double defocus_px = 0;  ///< radius of the disk that a point out of focus makes
  Vignetting vignetting;
  double supersampling = 2;  ///< rendered pixels per delivered pixel, in the middle, along each axis

  template <class Archive>
  void visit(Archive& a) {
    a("left", left);
    a("right", right);
    a("blur_px", blur_px, {.min = 0, .max = 20});
    a("defocus_px", defocus_px, {.min = 0, .max = 20});
    a("vignetting", vignetting);
    a("supersampling", supersampling, {.min = 0.5, .max = 4});
  }
  const Lens& lens(int camera) const { return camera == 0 ? left : right; }
};

/// The pinhole image that both cameras want rendered: wide enough for either lens.
struct RenderView {
  cv::Size size;
  double focal_px = 0;
  double cx_px = 0, cy_px = 0;  ///< the lens' direction (0, 0)
};

/// The pixels that a sensor reads out: columns and rows.
struct ReadPixels {
  std::vector<Extent> columns, rows;
  Mosaic mosaic = Mosaic::kNone;

  cv::Size size() const { return {static_cast<int>(columns.size()), static_cast<int>(rows.size())}; }
};

/// @throws std::domain_error when a lens sees nothing, or something twice, at a pixel
RenderView render_view(const Optics& optics, const ReadPixels& pixels);

/// One lens: rendered pinhole image -> light on the sensor. The image is blurred, then every pixel takes the
/// mean over its own footprint, seen back through the distortion, and what vignetting leaves of it.
class LensImage {
 public:
  /// @throws std::domain_error as render_view()
  LensImage(const Optics& optics, int camera, const ReadPixels& pixels, const RenderView& view);

  /// @param rendered  of the view's size: CV_8UC1, or CV_8UC3 (BGR) behind a colour mosaic, in which each
  ///                  pixel sees its own channel
  /// @param level     CV_32FC1, grey levels 0..255 of light, not rounded
  void expose(const cv::Mat& rendered, cv::Mat& level) const;

 private:
  cv::Size size_;
  double blur_px_;  ///< in rendered pixels
  cv::Mat disk_;    ///< likewise; empty without defocus
  AreaTable table_;
  std::vector<float> vignetting_;
};

/// A disk of a radius [px] as a filter kernel (CV_32FC1, sum 1), weights by covered area.
cv::Mat disk_kernel(double radius_px);

}  // namespace groundloop::sim
