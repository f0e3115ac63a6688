#include "slam/source/image_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "slam/types/config.h"

namespace groundloop::slam {

cv::Mat read_grey_image(const std::string& file, int width_px, int height_px) {
  const char* wanted = "an image that can be read";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(Problem{file, 0, "", "no such file", wanted});
  }
  cv::Mat image;
  try {
    image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(Problem{file, 0, "", "cannot be decoded", wanted});
  if (width_px > 0 && (image.cols != width_px || image.rows != height_px)) {
    throw InputError(Problem{file, 0, "", fmt::format("{}x{} pixels", image.cols, image.rows),
                             fmt::format("{}x{} pixels", width_px, height_px)});
  }
  return image;
}

}  // namespace groundloop::slam
