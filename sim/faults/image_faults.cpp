#include "sim/faults/image_faults.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <type_traits>

#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kStream = 0x64697274;  // "dirt"
constexpr double kSoftEdge = 0.4;         ///< part of a spot's radius over which it fades: it is out of focus

bool strikes(FaultCamera fault, int camera) {
  return fault == FaultCamera::kBoth || (fault == FaultCamera::kLeft) == (camera == 0);
}

/// Part of the light that a spot lets through at a distance from its centre.
double transmission(double distance_px, double radius_px, double opacity) {
  const double inside = std::clamp((radius_px - distance_px) / (kSoftEdge * radius_px), 0.0, 1.0);
  return 1 - opacity * inside * inside * (3 - 2 * inside);
}

template <class T>
void darken_spot(cv::Point2d centre_px, double radius_px, double opacity, cv::Mat& image) {
  constexpr double kRounding = std::is_integral_v<T> ? 0.5 : 0;
  const cv::Rect whole(0, 0, image.cols, image.rows);
  const cv::Rect box =
      cv::Rect(cv::Point(cvFloor(centre_px.x - radius_px), cvFloor(centre_px.y - radius_px)),
               cv::Point(cvCeil(centre_px.x + radius_px) + 1, cvCeil(centre_px.y + radius_px) + 1)) &
      whole;
  for (int v = box.y; v < box.br().y; ++v) {
    T* row = image.ptr<T>(v);
    for (int u = box.x; u < box.br().x; ++u) {
      const double distance_px = std::hypot(u - centre_px.x, v - centre_px.y);
      row[u] = static_cast<T>(row[u] * transmission(distance_px, radius_px, opacity) + kRounding);
    }
  }
}

void apply_dirt(const DirtFault& dirt, uint64_t seed, uint64_t stream, int pixels_per_px, cv::Mat& image) {
  uint64_t counter = 0;
  const auto uniform = [&] {
    return static_cast<double>(random_bits(seed, stream, counter++) >> 11) * 0x1p-53;
  };
  for (int spot = 0; spot < dirt.spots; ++spot) {
    const double u_px = uniform() * image.cols, v_px = uniform() * image.rows;
    const double radius_px = pixels_per_px * dirt.radius_px * (0.5 + uniform());
    const auto darken = image.depth() == CV_8U ? &darken_spot<uchar> : &darken_spot<float>;
    darken({u_px, v_px}, radius_px, dirt.opacity, image);
  }
}

/// Factor on every grey value from the light faults of this time.
double light_factor(const std::vector<Fault>& faults, int camera, double time_s) {
  double factor = 1;
  for (const Fault& fault : faults) {
    if (!fault.active(time_s)) continue;
    if (fault.exposure && strikes(fault.exposure->camera, camera)) factor *= fault.exposure->factor;
    if (fault.blackout && strikes(fault.blackout->camera, camera)) factor = 0;
    if (fault.flash) {
      const double left = std::isfinite(fault.end_s()) ? 1 - (time_s - fault.at_s) / *fault.for_s : 1;
      factor *= 1 + (fault.flash->factor - 1) * left;
    }
  }
  return factor;
}

}  // namespace

void apply_image_faults(const std::vector<Fault>& faults, uint64_t seed, int camera, double time_s,
                        cv::Mat& image, int pixels_per_px) {
  CV_Assert(image.type() == CV_8UC1 || image.type() == CV_32FC1);
  for (size_t i = 0; i < faults.size(); ++i) {
    const Fault& fault = faults[i];
    if (!fault.active(time_s)) continue;
    if (fault.blur && strikes(fault.blur->camera, camera)) {
      cv::GaussianBlur(image, image, {}, pixels_per_px * fault.blur->sigma_px, 0, cv::BORDER_REPLICATE);
    }
    if (fault.dirt && strikes(fault.dirt->camera, camera)) {
      apply_dirt(*fault.dirt, seed, kStream + 2 * i + static_cast<uint64_t>(camera), pixels_per_px, image);
    }
  }
  const double factor = light_factor(faults, camera, time_s);
  if (factor != 1) image.convertTo(image, image.type(), factor);
}

}  // namespace groundloop::sim
