#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Pinhole camera with the distortion of Brown and Conrady, in OpenCV's terms and order. Pixels are those of
/// the delivered image; the centre of the first one is (0, 0).
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),   u = fx x' + cx
///   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y,   v = fy y' + cy
/// where (x, y) = (X, Y) / Z and r^2 = x^2 + y^2.
struct Lens {
  double fx_px = 576.92;
  double fy_px = 576.92;
  double cx_px = 319.5;
  double cy_px = 239.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("fx_px", fx_px, {.min = 10, .max = 20000});
    a("fy_px", fy_px, {.min = 10, .max = 20000});
    a("cx_px", cx_px, {.min = -1000, .max = 6000});
    a("cy_px", cy_px, {.min = -1000, .max = 6000});
    a("k1", k1, {.min = -2, .max = 2});
    a("k2", k2, {.min = -4, .max = 4});
    a("p1", p1, {.min = -0.1, .max = 0.1});
    a("p2", p2, {.min = -0.1, .max = 0.1});
    a("k3", k3, {.min = -10, .max = 10});
  }

  /// Direction (x, y) with z = 1 -> pixel.
  Eigen::Vector2d pixel(const Eigen::Vector2d& xy) const;
  /// Pixel -> direction (x, y) with z = 1, by Newton's method; none where the distortion folds over, so that
  /// no direction, or more than one, is seen at that pixel.
  /// @param start  a direction nearby
  std::optional<Eigen::Vector2d> direction(const Eigen::Vector2d& uv_px, const Eigen::Vector2d& start) const;
  std::optional<Eigen::Vector2d> direction(const Eigen::Vector2d& uv_px) const;
  /// d pixel / d direction.
  Eigen::Matrix2d derivative(const Eigen::Vector2d& xy) const;
};

}  // namespace groundloop::sim
