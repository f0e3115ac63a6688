#include "slam/features/corner_response.h"

#include <cmath>

#include "slam/features/multiversion.h"

namespace groundloop::slam {
namespace {

constexpr int kWindow = 5;

/// @param n  pixels; one more is read on both sides
GROUNDLOOP_MULTIVERSION
void sobel(const uint8_t* __restrict above, const uint8_t* __restrict here, const uint8_t* __restrict below,
           int16_t* __restrict gx, int16_t* __restrict gy, int n) {
  for (int u = 0; u < n; ++u) {
    const int16_t a0 = above[u - 1], a1 = above[u], a2 = above[u + 1];
    const int16_t b0 = below[u - 1], b1 = below[u], b2 = below[u + 1];
    const int16_t h0 = here[u - 1], h2 = here[u + 1];
    gx[u] = static_cast<int16_t>((a2 - a0) + 2 * (h2 - h0) + (b2 - b0));
    gy[u] = static_cast<int16_t>((b0 - a0) + 2 * (b1 - a1) + (b2 - a2));
  }
}

/// Adds the products of a row that enters the window and takes off those of the row that leaves it.
GROUNDLOOP_MULTIVERSION
void roll(const int16_t* __restrict in_x, const int16_t* __restrict in_y, const int16_t* __restrict out_x,
          const int16_t* __restrict out_y, int32_t* __restrict xx, int32_t* __restrict xy,
          int32_t* __restrict yy, int n) {
  for (int u = 0; u < n; ++u) {
    const int32_t x1 = in_x[u], y1 = in_y[u], x0 = out_x[u], y0 = out_y[u];
    xx[u] += x1 * x1 - x0 * x0;
    xy[u] += x1 * y1 - x0 * y0;
    yy[u] += y1 * y1 - y0 * y0;
  }
}

/// @param n  windows; kWindow columns are read for each
GROUNDLOOP_MULTIVERSION
void smaller_eigenvalues(const int32_t* __restrict xx, const int32_t* __restrict xy,
                         const int32_t* __restrict yy, float scale, float* __restrict response, int n) {
  for (int u = 0; u < n; ++u) {
    const int32_t sum_xx = xx[u] + xx[u + 1] + xx[u + 2] + xx[u + 3] + xx[u + 4];
    const int32_t sum_xy = xy[u] + xy[u + 1] + xy[u + 2] + xy[u + 3] + xy[u + 4];
    const int32_t sum_yy = yy[u] + yy[u + 1] + yy[u + 2] + yy[u + 3] + yy[u + 4];
    const float half = 0.5F * static_cast<float>(sum_xx - sum_yy);
    const auto mixed = static_cast<float>(sum_xy);
    response[u] =
        scale * (0.5F * static_cast<float>(sum_xx + sum_yy) - std::sqrt(half * half + mixed * mixed));
  }
}

}  // namespace

const cv::Mat& CornerResponse::compute(const cv::Mat& grey) {
  response_.create(grey.size(), CV_32F);
  response_.setTo(0);
  const int n = grey.cols - 2;  // columns with a gradient
  if (n < kWindow || grey.rows < kWindow + 2) return response_;
  rows_.resize(kWindow);
  leaving_.x.resize(n);
  leaving_.y.resize(n);
  for (Gradients& row : rows_) {
    row.x.assign(n, 0);
    row.y.assign(n, 0);
  }
  for (std::vector<int32_t>* sums : {&xx_, &xy_, &yy_}) sums->assign(n, 0);

  constexpr float kUnit = 4 * kWindow * 255;  // the Sobel operator's, the window's and the grey value's
  for (int v = 1; v + 1 < grey.rows; ++v) {
    Gradients& row = rows_[v % kWindow];
    leaving_.x.swap(row.x);
    leaving_.y.swap(row.y);
    sobel(grey.ptr(v - 1) + 1, grey.ptr(v) + 1, grey.ptr(v + 1) + 1, row.x.data(), row.y.data(), n);
    roll(row.x.data(), row.y.data(), leaving_.x.data(), leaving_.y.data(), xx_.data(), xy_.data(), yy_.data(),
         n);
    if (v < kWindow) continue;
    smaller_eigenvalues(xx_.data(), xy_.data(), yy_.data(), 1 / (kUnit * kUnit),
                        response_.ptr<float>(v - kWindow / 2) + kReach_px, n - kWindow + 1);
  }
  return response_;
}

}  // namespace groundloop::slam
