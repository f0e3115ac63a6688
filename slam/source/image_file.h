#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace groundloop::slam {

/// Decodes an image to 8-bit grey; colour is converted.
/// @throws InputError naming the file when it is missing or no image, or when it has not the given size (0:
/// any)
cv::Mat read_grey_image(const std::string& file, int width_px = 0, int height_px = 0);

}  // namespace groundloop::slam
