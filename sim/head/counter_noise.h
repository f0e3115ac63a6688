#pragma once

#include <array>
#include <cstdint>

namespace groundloop::sim {

/// Noise that is a function of its keys alone. One 64-bit word serves several pixels: kQuantileBits of it
/// choose one of kQuantiles equally likely values of a standard normal variable, scaled so that their
/// variance is exactly 1.
inline constexpr int kQuantileBits = 12;
inline constexpr int kQuantiles = 1 << kQuantileBits;
const std::array<float, kQuantiles>& normal_quantiles();

/// Mixes 64 bits so that every input bit changes every output bit with probability 1/2 (Steele, Lea & Flood,
/// "Fast splittable pseudorandom number generators", OOPSLA 2014: the finaliser of SplitMix64).
constexpr uint64_t mix_word(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  x ^= x >> 31;
  return x;
}
/// Odd, so that counter * kGolden visits all 64-bit values.
inline constexpr uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

/// Key of the noise of one camera's frame; its n-th word is mix_word(key + kGolden * n), n from 1.
constexpr uint64_t stream_key(uint64_t seed, int camera, int64_t frame) {
  uint64_t key = mix_word(seed + kGolden);
  key = mix_word(key ^ (static_cast<uint64_t>(camera) + kGolden));
  return mix_word(key ^ (static_cast<uint64_t>(frame) + kGolden));
}

}  // namespace groundloop::sim
