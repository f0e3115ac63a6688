#include "bench/report/plate.h"

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "bench/report/canvas.h"

namespace groundloop::bench {
namespace {

constexpr int kWidth = 1600, kMargin = 16, kGap = 20, kTitle = 34;

/// Common height of a row's pictures.
int height_of(const std::vector<PlatePanel>& row) {
  double widths = 0;  // of pictures of unit height
  for (const PlatePanel& panel : row) {
    if (panel.bgr.empty()) throw std::invalid_argument("draw_plate: no picture '" + panel.title + "'");
    widths += static_cast<double>(panel.bgr.cols) / panel.bgr.rows;
  }
  if (row.empty()) throw std::invalid_argument("draw_plate: a row without pictures");
  return static_cast<int>((kWidth - 2 * kMargin - kGap * static_cast<double>(row.size() - 1)) / widths);
}

cv::Mat sized(const cv::Mat& picture, int height) {
  const cv::Size size(cvRound(static_cast<double>(picture.cols) * height / picture.rows), height);
  cv::Mat resized, bgr;
  cv::resize(picture, resized, size, 0, 0, size.height < picture.rows ? cv::INTER_AREA : cv::INTER_LINEAR);
  if (resized.channels() == 3) return resized;
  cv::cvtColor(resized, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

}  // namespace

cv::Mat draw_plate(const std::vector<std::vector<PlatePanel>>& rows) {
  int height = kMargin;
  for (const auto& row : rows) height += kTitle + height_of(row) + kGap;
  Canvas canvas(kWidth, height, palette::kPaper);
  int y = kMargin;
  for (const auto& row : rows) {
    int x = kMargin;
    const int row_height = height_of(row);
    for (const PlatePanel& panel : row) {
      const cv::Mat picture = sized(panel.bgr, row_height);
      canvas.text({x + 0.0, y + 20.0}, panel.title, 14, palette::kInk);
      canvas.picture({x, y + kTitle}, picture);
      canvas.frame(cv::Rect2d(x, y + kTitle, picture.cols, picture.rows), palette::kGrid, 1);
      x += picture.cols + kGap;
    }
    y += kTitle + row_height + kGap;
  }
  return canvas.image();
}

}  // namespace groundloop::bench
