#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace groundloop::textures {

/// A repeatable sequence of random draws: the same key gives the same draws on every machine.
class Dice {
 public:
  explicit Dice(uint64_t key) : key_(key) {}
  double uniform(double low = 0, double high = 1);
  int integer(int low, int high);  ///< both ends included
  bool chance(double probability) { return uniform() < probability; }

 private:
  uint64_t key_;
  uint64_t counter_ = 0;
};

/// Colours as red, green, blue in 0..255; OpenCV's order is the reverse.
cv::Scalar rgb(double red, double green, double blue);
/// The colour made lighter (> 1) or darker (< 1).
cv::Scalar shade(const cv::Scalar& colour, double factor);

/// Sum of octaves of smooth value noise, tileable, CV_32F with mean near 0.5 in [0, 1].
/// @param cells  lattice cells of the first octave over the image
cv::Mat noise(cv::Size size, cv::Size cells, int octaves, uint64_t key);

/// A canvas of one colour, modulated by noise: colour * (1 + amount * (noise - 0.5) * 2).
cv::Mat mottled(cv::Size size, const cv::Scalar& colour, double amount, cv::Size cells, int octaves,
                uint64_t key);

/// Multiplies the canvas by 1 + amount * (field - 0.5) * 2.
void modulate(cv::Mat& canvas, const cv::Mat& field, double amount);

void fill(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& colour);
void frame(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& colour, int width_px = 1);
/// One line of text whose capitals are `height_px` high, its baseline starting at (x, y).
void write(cv::Mat& canvas, const std::string& text, cv::Point at, double height_px, const cv::Scalar& colour,
           int width_px = 1);
/// A made-up word of the laboratory's vocabulary.
std::string word(Dice& dice);
/// Lines of words that fill a box.
void paragraph(cv::Mat& canvas, const cv::Rect& box, double height_px, const cv::Scalar& colour, Dice& dice);
/// Axes with a few noisy curves.
void plot(cv::Mat& canvas, const cv::Rect& box, const cv::Scalar& ground, const cv::Scalar& ink, Dice& dice);

}  // namespace groundloop::textures
