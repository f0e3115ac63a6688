#include "sim/head/lens.h"

#include <Eigen/LU>

namespace groundloop::sim {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d Lens::pixel(const Vector2d& xy) const {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {fx_px * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cx_px,
          fy_px * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + cy_px};
}

Matrix2d Lens::derivative(const Vector2d& xy) const {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d radial / d x = slope * x
  const double mixed = slope * x * y + 2 * p1 * x + 2 * p2 * y;
  Matrix2d J;
  J << fx_px * (radial + slope * x * x + 2 * p1 * y + 6 * p2 * x), fx_px * mixed,  //
      fy_px * mixed, fy_px * (radial + slope * y * y + 6 * p1 * y + 2 * p2 * x);
  return J;
}

std::optional<Vector2d> Lens::direction(const Vector2d& uv_px, const Vector2d& start) const {
  constexpr int kSteps = 30;
  constexpr double kExact_px = 1e-10;
  Vector2d xy = start;
  for (int i = 0; i < kSteps; ++i) {
    const Matrix2d J = derivative(xy);
    if (!(J.determinant() > 0)) return std::nullopt;
    const Vector2d error_px = uv_px - pixel(xy);
    if (error_px.squaredNorm() < kExact_px * kExact_px) return xy;
    xy += J.inverse() * error_px;
  }
  return std::nullopt;
}

std::optional<Vector2d> Lens::direction(const Vector2d& uv_px) const {
  return direction(uv_px, {(uv_px.x() - cx_px) / fx_px, (uv_px.y() - cy_px) / fy_px});
}

}  // namespace groundloop::sim
