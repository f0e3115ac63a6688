#include "sim/robot/odometry.h"

#include <cmath>
#include <numbers>

#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kStream = 0x6f646f6d65747279;  // "odometry"

/// Standard normal number of a key (Box and Muller 1958).
double gaussian(uint64_t seed, uint64_t stream, uint64_t counter) {
  const auto uniform = [](uint64_t bits) {
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
  };  // in (0, 1)
  const double u = uniform(random_bits(seed, stream, 2 * counter));
  const double v = uniform(random_bits(seed, stream, 2 * counter + 1));
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

}  // namespace

Odometry::Odometry(const OdometryModel& model, const DriveLimits& drive, uint64_t seed, double left_rad,
                   double right_rad)
    : model_(model), seed_(seed), track_m_(drive.track_m / model.track_ratio), counts_{} {
  // Wheels of mean radius R and ratio E_d have radii R 2 / (E_d + 1) and R 2 E_d / (E_d + 1). Taking both as
  // R reads the left wheel's way too long and the right one's too short by these factors.
  const double way_m = 2 * std::numbers::pi * drive.wheel_radius_m / model.counts_per_rev;
  const double e = model.diameter_ratio;
  way_m_per_count_ = {way_m * (e + 1) / 2, way_m * (e + 1) / (2 * e)};
  counts_ = {counts_of(left_rad), counts_of(right_rad)};
}

int64_t Odometry::counts_of(double angle_rad) const {
  return static_cast<int64_t>(std::floor(angle_rad / (2 * std::numbers::pi) * model_.counts_per_rev));
}

double Odometry::measured_way_m(int wheel, double angle_rad) {
  const int64_t counts = counts_of(angle_rad);
  const double way_m = static_cast<double>(counts - counts_[wheel]) * way_m_per_count_[wheel];
  counts_[wheel] = counts;
  if (way_m == 0 || model_.noise_m_per_sqrt_m == 0) return way_m;
  return way_m +
         model_.noise_m_per_sqrt_m * std::sqrt(std::abs(way_m)) * gaussian(seed_, kStream + wheel, updates_);
}

void Odometry::update(double left_rad, double right_rad) {
  const double left_m = measured_way_m(0, left_rad);
  const double right_m = measured_way_m(1, right_rad);
  T_odom_body_ = driven(T_odom_body_, (left_m + right_m) / 2, (right_m - left_m) / track_m_);
  ++updates_;
}

}  // namespace groundloop::sim
