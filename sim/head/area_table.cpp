#include "sim/head/area_table.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

/// A convex polygon. A quadrilateral cut to a cell of a grid has at most eight corners.
struct Polygon {
  std::array<Vector2d, 10> corner;
  int corners = 0;

  void add(const Vector2d& p) { corner[static_cast<size_t>(corners++)] = p; }
  const Vector2d& at(int i) const { return corner[static_cast<size_t>(i % corners)]; }

  double area() const {
    double twice = 0;
    for (int i = 0; i < corners; ++i) {
      twice += at(i).x() * at(i + 1).y() - at(i).y() * at(i + 1).x();
    }
    return 0.5 * std::abs(twice);
  }
  std::pair<double, double> range(int axis) const {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < corners; ++i) {
      low = std::min(low, at(i)[axis]);
      high = std::max(high, at(i)[axis]);
    }
    return {low, high};
  }
};

/// Cuts along the line where coordinate `axis` is `at`.
void cut(const Polygon& whole, int axis, double at, Polygon& below, Polygon& above) {
  below.corners = above.corners = 0;
  for (int i = 0; i < whole.corners; ++i) {
    const Vector2d &p = whole.at(i), &q = whole.at(i + 1);
    (p[axis] < at ? below : above).add(p);
    if ((p[axis] < at) == (q[axis] < at)) continue;
    const Vector2d on_line = p + (at - p[axis]) / (q[axis] - p[axis]) * (q - p);
    below.add(on_line);
    above.add(on_line);
  }
}

/// Calls visit(cell, part) with the parts of a polygon in the unit cells [cell, cell + 1) of an axis.
template <class Visit>
void for_each_cell(Polygon rest, int axis, const Visit& visit) {
  const auto [low, high] = rest.range(axis);
  const int first = static_cast<int>(std::floor(low));
  const int last = std::max(first, static_cast<int>(std::ceil(high)) - 1);
  Polygon part, above;
  for (int cell = first; cell < last; ++cell) {
    cut(rest, axis, cell + 1, part, above);
    if (part.corners > 2) visit(cell, part);
    rest = above;
  }
  if (rest.corners > 2) visit(last, rest);
}

}  // namespace

void AreaTable::add(const Footprint& footprint, int channel) {
  Polygon whole;
  for (const Vector2d& corner : footprint) whole.add(corner + Vector2d(0.5, 0.5));  // cells are pixels
  const auto [left, right] = whole.range(0);
  const auto [top, bottom] = whole.range(1);
  if (!(left >= 0 && top >= 0 && right <= input_.width && bottom <= input_.height) || !(whole.area() > 0)) {
    throw std::invalid_argument("AreaTable: a footprint that is not inside the image, or without area");
  }
  const size_t first_tap = taps_.size();
  areas_.clear();
  for_each_cell(whole, 1, [&](int row, const Polygon& strip) {
    const auto [from, to] = strip.range(0);
    const int first = static_cast<int>(std::floor(from));
    const int taps = std::max(1, (static_cast<int>(std::ceil(to)) - first + kWidth - 1) / kWidth);
    const int start = std::min(first, input_.width - taps * kWidth);  // no tap reads past the end of the row
    const size_t base = areas_.size();
    for (int t = 0; t < taps; ++t) {
      taps_.push_back({row * input_.width + start + t * kWidth, {}});
      areas_.insert(areas_.end(), kWidth, 0.0);
    }
    for_each_cell(strip, 0, [&](int col, const Polygon& part) {
      // a part without width may touch the image's end from outside
      areas_[base + static_cast<size_t>(std::min(col, input_.width - 1) - start)] += part.area();
    });
  });
  round_weights(first_tap, areas_);
  end_.push_back(static_cast<uint32_t>(taps_.size()));
  channel_.push_back(static_cast<uint8_t>(channel));
}

/// Rounds the running sum, so that the weights add up to the whole.
void AreaTable::round_weights(size_t first_tap, const std::vector<double>& areas) {
  double whole = 0;
  for (const double area : areas) whole += area;
  double sum = 0;
  long given = 0;
  for (size_t i = 0; i < areas.size(); ++i) {
    sum += areas[i];
    const long up_to_here = std::lround(sum / whole * kOne);
    taps_[first_tap + i / kWidth].weight[i % kWidth] = static_cast<int16_t>(up_to_here - given);
    given = up_to_here;
  }
}

void AreaTable::apply(const cv::Mat& image, const std::vector<float>& factor, cv::Mat& output) const {
  CV_Assert(image.size() == input_ && image.isContinuous() && image.depth() == CV_8U);
  CV_Assert(output.type() == CV_32FC1 && output.isContinuous() && output.total() == end_.size() &&
            factor.size() == end_.size());
  if (image.channels() == 1) {
    apply_channels<1>(image.ptr(), factor, output.ptr<float>());
  } else {
    CV_Assert(image.channels() == 3);
    apply_channels<3>(image.ptr(), factor, output.ptr<float>());
  }
}

template <int kChannels>
void AreaTable::apply_channels(const uchar* input, const std::vector<float>& factor, float* output) const {
  const Tap* tap = taps_.data();
  for (size_t i = 0; i < end_.size(); ++i) {
    const Tap* const end = taps_.data() + end_[i];
    const uchar* const plane = input + (kChannels > 1 ? channel_[i] : 0);
    int32_t sum = 0;
    for (; tap != end; ++tap) {
      const uchar* const run = plane + static_cast<ptrdiff_t>(tap->first) * kChannels;
      for (int k = 0; k < kWidth; ++k) sum += tap->weight[static_cast<size_t>(k)] * run[k * kChannels];
    }
    output[i] = static_cast<float>(sum) * (factor[i] * (1.0F / kOne));
  }
}

}  // namespace groundloop::sim
