#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace groundloop::sim {

/// A pair as the STH-MDCS sends it: two bytes a pixel, row by row, in what the bus calls YUV422; the first is
/// the right camera's, the second the left one's.
/// @param left, right  CV_8UC1 of one size
std::vector<uint8_t> interleaved(const cv::Mat& left, const cv::Mat& right);

}  // namespace groundloop::sim
