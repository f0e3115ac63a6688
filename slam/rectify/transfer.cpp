#include "slam/rectify/transfer.h"

#include <fmt/format.h>

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace groundloop::slam {

void deinterleave(std::span<const uint8_t> bytes, cv::Size size, FirstByte first, cv::Mat& left,
                  cv::Mat& right) {
  const size_t wanted = 2 * static_cast<size_t>(size.width) * static_cast<size_t>(size.height);
  if (bytes.size() != wanted) {
    throw std::invalid_argument(
        fmt::format("a pair of {} bytes; {}x{} has {}", bytes.size(), size.width, size.height, wanted));
  }
  const cv::Mat pairs(size, CV_8UC2, const_cast<uint8_t*>(bytes.data()));  // read only
  cv::extractChannel(pairs, first == FirstByte::kLeft ? left : right, 0);
  cv::extractChannel(pairs, first == FirstByte::kLeft ? right : left, 1);
}

void mosaic_to_grey(ColourFilter filter, cv::Mat& image) {
  // OpenCV names a pattern by the second row's second and third pixel.
  int code = 0;
  switch (filter) {
    case ColourFilter::kNone:
      return;
    case ColourFilter::kRggb:
      code = cv::COLOR_BayerBG2GRAY;
      break;
    case ColourFilter::kGrbg:
      code = cv::COLOR_BayerGB2GRAY;
      break;
    case ColourFilter::kGbrg:
      code = cv::COLOR_BayerGR2GRAY;
      break;
    case ColourFilter::kBggr:
      code = cv::COLOR_BayerRG2GRAY;
      break;
  }
  cv::Mat grey;
  cv::cvtColor(image, grey, code);
  image = grey;
}

}  // namespace groundloop::slam
