#include "bench/report/html.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace groundloop::bench {

std::string escape_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string base64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t present = std::min<size_t>(3, bytes.size() - i);
    uint32_t triple = 0;
    for (size_t k = 0; k < 3; ++k) triple = triple << 8 | (k < present ? bytes[i + k] : 0U);
    for (size_t k = 0; k < 4; ++k) text += k <= present ? kDigits[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Picture packed(const cv::Mat& bgr) {
  Picture picture{bgr, {}};
  cv::imencode(".png", bgr, picture.png);
  return picture;
}

std::string image_uri(const Picture& picture, Content content, size_t max_bytes) {
  if (picture.png.size() <= max_bytes) return "data:image/png;base64," + base64(picture.png);
  std::vector<uint8_t> bytes;
  if (content == Content::kDrawn) {
    cv::imencode(".png", picture.bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
    if (bytes.size() <= max_bytes) return "data:image/png;base64," + base64(bytes);
  }
  cv::Mat image = picture.bgr;
  for (int quality = 90;; quality -= 10) {
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    if (bytes.size() <= max_bytes || image.cols < 200) return "data:image/jpeg;base64," + base64(bytes);
    if (quality == 70) {
      quality = 100;
      cv::resize(image, image, image.size() * 3 / 4, 0, 0, cv::INTER_AREA);
    }
  }
}

}  // namespace groundloop::bench
