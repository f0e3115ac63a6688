#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace groundloop::bench {

/// Text made safe for HTML element content and quoted attributes.
std::string escape_html(const std::string& text);

/// A picture, and the same as a PNG packed fast.
struct Picture {
  cv::Mat bgr;
  std::vector<uint8_t> png;
};
Picture packed(const cv::Mat& bgr);

/// Flat colours and lines get much smaller by patience, photographs do not.
enum class Content { kDrawn, kPhoto };

/// A picture as a data URI: PNG where that is small, else JPEG of high quality.
/// @param max_bytes  size of the encoded picture above which quality, then resolution, is given up
std::string image_uri(const Picture& picture, Content content, size_t max_bytes);

/// Base64 (RFC 4648) of bytes.
std::string base64(const std::vector<uint8_t>& bytes);

}  // namespace groundloop::bench
