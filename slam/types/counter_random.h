#pragma once

#include <cstdint>

namespace groundloop {

/// Counter-based random bits: a function of its keys alone, so that nothing depends on order or threads.
/// The mixing is SplitMix64's finaliser (Steele, Lea & Flood 2014).
constexpr uint64_t mix_bits(uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

constexpr uint64_t random_bits(uint64_t seed, uint64_t stream, uint64_t counter) {
  return mix_bits(mix_bits(mix_bits(seed) ^ stream) ^ counter);
}

/// A whole number in [0, n).
constexpr uint32_t random_index(uint64_t bits, uint32_t n) {
  return static_cast<uint32_t>((static_cast<uint64_t>(static_cast<uint32_t>(bits >> 32)) * n) >> 32);
}

}  // namespace groundloop
