#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/types/counter_random.h"

namespace groundloop::sim {

/// A repeatable sequence of draws from (seed, stream): the same on every machine.
class Dice {
 public:
  explicit Dice(uint64_t seed, uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  /// Both ends included.
  int integer(int low, int high) {
    return low + static_cast<int>(random_index(next(), static_cast<uint32_t>(high - low + 1)));
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  template <class T>
  const T& pick(const std::vector<T>& choices) {
    return choices[random_index(next(), static_cast<uint32_t>(choices.size()))];
  }

 private:
  uint64_t next() { return random_bits(seed_, stream_, counter_++); }

  uint64_t seed_;
  uint64_t stream_;
  uint64_t counter_ = 0;
};

}  // namespace groundloop::sim
