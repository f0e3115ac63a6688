#pragma once

#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// How a sensor makes a smaller image than it has pixels.
enum class Reduction {
  kNone,
  kDecimation,  ///< the chip reads every n-th pixel and skips the others: nothing is averaged, so it aliases
  kBinning      ///< all are read, and the host averages n x n
};

/// The colour filters over the sensor's first two rows, or none.
enum class Mosaic { kNone, kRggb, kGrbg, kGbrg, kBggr };

/// Colour channel (0 blue, 1 green, 2 red) of the pixel in a row and column of a mosaic.
int channel_of(Mosaic mosaic, int row, int col);

/// Extent of one light-sensitive pixel along one axis, in pixels of the delivered image.
struct Extent {
  double from, to;
};

/// The pixels that are read out along one axis. Plain decimation by n reads n k; behind a colour mosaic it
/// reads pairs (2 n k, 2 n k + 1), so that the colours stay, and coordinates are those of the pairs' middles.
std::vector<Extent> read_pixels(int delivered, Reduction reduction, int factor, Mosaic mosaic);

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::Reduction> {
  static constexpr std::array<std::pair<sim::Reduction, const char*>, 3> names = {
      {{sim::Reduction::kNone, "none"},
       {sim::Reduction::kDecimation, "decimation"},
       {sim::Reduction::kBinning, "binning"}}};
};
template <>
struct EnumNames<sim::Mosaic> {
  static constexpr std::array<std::pair<sim::Mosaic, const char*>, 5> names = {
      {{sim::Mosaic::kNone, "none"},
       {sim::Mosaic::kRggb, "rggb"},
       {sim::Mosaic::kGrbg, "grbg"},
       {sim::Mosaic::kGbrg, "gbrg"},
       {sim::Mosaic::kBggr, "bggr"}}};
};
}  // namespace groundloop
