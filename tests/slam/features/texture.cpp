#include "tests/slam/features/texture.h"

namespace groundloop::slam {

Texture::Texture(uint64_t seed, double shortest, double longest, int waves)
    : amplitude_(35 * std::sqrt(2.0 / waves)) {
  for (int i = 0; i < waves; ++i) {
    const auto n = static_cast<uint64_t>(i);
    const Eigen::Vector3d direction(gaussian(seed, 1, n), gaussian(seed, 2, n), gaussian(seed, 3, n));
    const double length = shortest * std::pow(longest / shortest, uniform(seed, 100, n));
    waves_.push_back({2 * std::numbers::pi / length * direction.normalized(),
                      2 * std::numbers::pi * uniform(seed, 101, n)});
  }
}

double Texture::at(const Eigen::Vector3d& p) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::sin(wave.k.dot(p) + wave.phase);
  return 128 + amplitude_ * sum;
}

}  // namespace groundloop::slam
