#include "slam/mapping/occupied_field.h"

#include <algorithm>
#include <array>

namespace groundloop::slam {
namespace {

/// Cells around the wanted part whose splines reach into it.
constexpr int kReach = 3;

/// Replaces every run of three cells along a stride by a b a of them; the outermost cells stay.
void blur(std::vector<float>& values, const GridGeometry& geometry, float side, float middle) {
  std::vector<float> rows(values);
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 1; col + 1 < geometry.cols; ++col) {
      const size_t i = geometry.index(col, row);
      rows[i] = middle * values[i] + side * (values[i - 1] + values[i + 1]);
    }
  }
  const auto up = static_cast<size_t>(geometry.cols);
  for (int row = 1; row + 1 < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      const size_t i = geometry.index(col, row);
      values[i] = middle * rows[i] + side * (rows[i - up] + rows[i + up]);
    }
  }
}

/// The four cubic B-splines that reach to a place, by the place's distance t in [0, 1) past the second one's
/// centre; with their first and second derivative.
struct Splines {
  explicit Splines(double t) {
    const double s = 1 - t;
    value = {s * s * s / 6, (4 - 3 * t * t * (1 + s)) / 6, (4 - 3 * s * s * (1 + t)) / 6, t * t * t / 6};
    slope = {-s * s / 2, t * (3 * t - 4) / 2, -s * (3 * s - 4) / 2, t * t / 2};
    bend = {s, 3 * t - 2, 3 * s - 2, t};
  }
  std::array<double, 4> value, slope, bend;
};

/// First of the four cells, and the place's distance past the second.
struct Place {
  Place(double p_m, double min_m, double cell_m, int cells) {
    const double along = (p_m - min_m) / cell_m - 0.5;
    const double floor = std::floor(along);
    first = static_cast<int>(floor) - 1;
    t = along - floor;
    inside = first >= 0 && first + 3 < cells;
  }
  int first;
  double t;
  bool inside;
};

}  // namespace

OccupiedField::OccupiedField(const OccupancyMap& map, const Eigen::Vector2d& low_m,
                             const Eigen::Vector2d& high_m) {
  const GridGeometry& whole = map.geometry;
  const int col_min = whole.col_of(low_m.x()) - kReach, row_min = whole.row_of(low_m.y()) - kReach;
  geometry_ = {whole.cell_m, whole.x_min_m + col_min * whole.cell_m, whole.y_min_m + row_min * whole.cell_m,
               whole.col_of(high_m.x()) + kReach + 1 - col_min,
               whole.row_of(high_m.y()) + kReach + 1 - row_min};
  weight_.assign(geometry_.cells(), 0);
  for (int row = 0; row < geometry_.rows; ++row) {
    for (int col = 0; col < geometry_.cols; ++col) {
      if (!whole.contains(col_min + col, row_min + row)) continue;
      weight_[geometry_.index(col, row)] = std::max(0.0F, 2 * map.at(col_min + col, row_min + row) - 1);
    }
  }
  blur(weight_, geometry_, 0.25F, 0.5F);
}

std::vector<float> OccupiedField::at_centres() const {
  std::vector<float> values = weight_;
  blur(values, geometry_, 1.0F / 6, 4.0F / 6);
  return values;
}

double OccupiedField::value(const Eigen::Vector2d& p_m) const {
  const Place x(p_m.x(), geometry_.x_min_m, geometry_.cell_m, geometry_.cols);
  const Place y(p_m.y(), geometry_.y_min_m, geometry_.cell_m, geometry_.rows);
  if (!x.inside || !y.inside) return 0;
  const Splines along_x(x.t), along_y(y.t);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const float* w = &weight_[geometry_.index(x.first, y.first + j)];
    const auto& v = along_x.value;
    sum += along_y.value[j] * (v[0] * w[0] + v[1] * w[1] + v[2] * w[2] + v[3] * w[3]);
  }
  return sum;
}

OccupiedField::Jet OccupiedField::jet(const Eigen::Vector2d& p_m) const {
  const Place x(p_m.x(), geometry_.x_min_m, geometry_.cell_m, geometry_.cols);
  const Place y(p_m.y(), geometry_.y_min_m, geometry_.cell_m, geometry_.rows);
  Jet jet;
  if (!x.inside || !y.inside) return jet;
  const Splines along_x(x.t), along_y(y.t);
  for (int j = 0; j < 4; ++j) {
    double value = 0, slope = 0, bend = 0;
    for (int i = 0; i < 4; ++i) {
      const double w = weight_[geometry_.index(x.first + i, y.first + j)];
      value += along_x.value[i] * w, slope += along_x.slope[i] * w, bend += along_x.bend[i] * w;
    }
    jet.value += along_y.value[j] * value;
    jet.gradient += Eigen::Vector2d(along_y.value[j] * slope, along_y.slope[j] * value);
    jet.hessian(0, 0) += along_y.value[j] * bend;
    jet.hessian(0, 1) += along_y.slope[j] * slope;
    jet.hessian(1, 1) += along_y.bend[j] * value;
  }
  jet.hessian(1, 0) = jet.hessian(0, 1);
  jet.gradient /= geometry_.cell_m;
  jet.hessian /= geometry_.cell_m * geometry_.cell_m;
  return jet;
}

}  // namespace groundloop::slam
