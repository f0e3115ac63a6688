#include "sim/head/pixel_grid.h"

namespace groundloop::sim {

int channel_of(Mosaic mosaic, int row, int col) {
  // position of red in the first two rows and columns; blue is diagonally opposite
  int red_row = 0, red_col = 0;
  switch (mosaic) {
    case Mosaic::kNone:
      return 1;
    case Mosaic::kRggb:
      break;
    case Mosaic::kGrbg:
      red_col = 1;
      break;
    case Mosaic::kGbrg:
      red_row = 1;
      break;
    case Mosaic::kBggr:
      red_row = red_col = 1;
      break;
  }
  const bool in_red_row = row % 2 == red_row, in_red_col = col % 2 == red_col;
  if (in_red_row != in_red_col) return 1;
  return in_red_row ? 2 : 0;
}

std::vector<Extent> read_pixels(int delivered, Reduction reduction, int factor, Mosaic mosaic) {
  std::vector<Extent> extents;
  if (reduction == Reduction::kNone) factor = 1;
  const double width = 1.0 / factor;
  const auto add = [&](double centre) { extents.push_back({centre - 0.5 * width, centre + 0.5 * width}); };
  const int read = reduction == Reduction::kBinning ? delivered * factor : delivered;
  for (int i = 0; i < read; ++i) {
    if (reduction == Reduction::kBinning) {
      add((i - 0.5 * (factor - 1)) * width);
    } else if (mosaic == Mosaic::kNone) {
      add(i);
    } else {
      const int first_of_pair = i - i % 2;
      add(first_of_pair + 0.5 + (i % 2 - 0.5) * width);
    }
  }
  return extents;
}

}  // namespace groundloop::sim
