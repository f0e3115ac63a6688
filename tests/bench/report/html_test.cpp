#include "bench/report/html.h"

#include <gtest/gtest.h>

namespace groundloop::bench {
namespace {

std::vector<uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Html, EscapesWhatHtmlReadsAsMarkup) {
  EXPECT_EQ(escape_html("<a href=\"x\">Tom & 'Jerry'</a>"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
}

TEST(Html, Base64EqualsTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(bytes("")), "");
  EXPECT_EQ(base64(bytes("f")), "Zg==");
  EXPECT_EQ(base64(bytes("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes("foobar")), "Zm9vYmFy");
  EXPECT_EQ(base64({0xff, 0xfe, 0xfd}), "//79");
}

TEST(Html, PicturesKeepToTheirSize) {
  cv::Mat flat(200, 300, CV_8UC3, cv::Scalar(10, 20, 30)), noise(600, 800, CV_8UC3);
  uint32_t state = 1;
  for (auto it = noise.begin<cv::Vec3b>(); it != noise.end<cv::Vec3b>(); ++it) {
    state = state * 1664525U + 1013904223U;
    *it = {static_cast<uint8_t>(state >> 8), static_cast<uint8_t>(state >> 16),
           static_cast<uint8_t>(state >> 24)};
  }
  EXPECT_TRUE(image_uri(packed(flat), Content::kDrawn, 5000).starts_with("data:image/png;base64,iVBOR"));
  // a pattern that only patience packs well
  cv::Mat pattern(200, 300, CV_8UC3);
  for (int v = 0; v < pattern.rows; ++v) noise.row(v % 16).colRange(0, pattern.cols).copyTo(pattern.row(v));
  EXPECT_GT(packed(pattern).png.size(), 30'000U);
  EXPECT_TRUE(image_uri(packed(pattern), Content::kDrawn, 30'000).starts_with("data:image/png"));
  EXPECT_TRUE(image_uri(packed(pattern), Content::kPhoto, 30'000).starts_with("data:image/jpeg"));
  const std::string small = image_uri(packed(noise), Content::kDrawn, 60'000);
  EXPECT_TRUE(small.starts_with("data:image/jpeg;base64,/9j/"));
  EXPECT_LE(small.size(), 60'000U * 4 / 3 + 40);
}

}  // namespace
}  // namespace groundloop::bench
