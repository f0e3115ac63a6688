#include "slam/features/image_pyramid.h"

#include <opencv2/imgproc.hpp>

namespace groundloop::slam {

void ImagePyramid::build(const cv::Mat& grey, int levels) {
  CV_Assert(grey.type() == CV_8UC1 && levels >= 1);
  levels_.resize(levels);
  // Binomial 3 x 3 smoothing: it limits the bilinear interpolation bias of sub-pixel tracking. Its weights
  // sum to kScale, so the scaled result is exact.
  static const cv::Mat kBinomial = (cv::Mat_<float>(3, 1) << 1, 2, 1);
  cv::sepFilter2D(grey, levels_[0], CV_16S, kBinomial, kBinomial, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
  for (int l = 1; l < levels; ++l) cv::pyrDown(levels_[l - 1], levels_[l]);
}

}  // namespace groundloop::slam
