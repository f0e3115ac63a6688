#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace groundloop::slam {

/// Which camera's byte comes first in a byte-interleaved pair. Videre's drivers say the right one, its manual
/// the left one: cover a lens to know.
enum class FirstByte { kRight, kLeft };

/// A pair as a Videre head sends it: two bytes a pixel, row by row.
/// @param bytes  2 * width * height
/// @param left, right  CV_8UC1; a colour mosaic stays one
/// @throws std::invalid_argument when the number of bytes is another
void deinterleave(std::span<const uint8_t> bytes, cv::Size size, FirstByte first, cv::Mat& left,
                  cv::Mat& right);

/// The colour filters of a raw image, by its first two pixels in each of its first two rows.
enum class ColourFilter { kNone, kRggb, kGrbg, kGbrg, kBggr };

/// Grey (Rec. 601) of a raw image behind colour filters, bilinear between pixels of a colour; in place.
void mosaic_to_grey(ColourFilter filter, cv::Mat& image);

}  // namespace groundloop::slam
