#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace groundloop::bench {

/// One picture of a plate, under its title.
struct PlatePanel {
  std::string title;
  cv::Mat bgr;  ///< grey or BGR, 8 bit
};

/// Pictures side by side on one, 1600 px wide, BGR: the panels of a row have one height and fill the width.
/// @throws std::invalid_argument when a row or a picture is empty
cv::Mat draw_plate(const std::vector<std::vector<PlatePanel>>& rows);

}  // namespace groundloop::bench
