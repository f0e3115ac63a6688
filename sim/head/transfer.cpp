#include "sim/head/transfer.h"

#include <opencv2/core.hpp>

namespace groundloop::sim {

std::vector<uint8_t> interleaved(const cv::Mat& left, const cv::Mat& right) {
  CV_Assert(left.type() == CV_8UC1 && right.type() == CV_8UC1 && left.size() == right.size());
  std::vector<uint8_t> bytes(2 * left.total());
  cv::Mat pairs(left.size(), CV_8UC2, bytes.data());
  const std::array<cv::Mat, 2> in_order = {right, left};
  cv::merge(in_order.data(), in_order.size(), pairs);
  return bytes;
}

}  // namespace groundloop::sim
