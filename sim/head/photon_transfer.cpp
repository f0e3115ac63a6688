#include "sim/head/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace groundloop::sim {
namespace {

constexpr double kQuantisation_dn2 = 1.0 / 12;
/// With less noise than this, rounding is no noise of its own that adds 1/12 (EMVA 1288 wants 0.24).
constexpr double kResolved_dn2 = 0.3;

struct FieldStatistics {
  double mean_dn = 0;
  double temporal_dn2 = 0;  ///< variance of a pixel over the frames, mean over the pixels
  double spatial_dn2 = 0;   ///< variance over the pixels of what they are on average
  double weight = 0;        ///< of temporal_dn2 in a fit: one over its own variance
};

FieldStatistics statistics_of(const FlatField& field) {
  if (field.size() < 2) throw std::invalid_argument("photon_transfer: a field needs two frames or more");
  const auto frames = static_cast<double>(field.size());
  cv::Mat sum = cv::Mat::zeros(field.front().size(), CV_64F), squares = sum.clone(), frame;
  for (const cv::Mat& image : field) {
    image.convertTo(frame, CV_64F);
    sum += frame;
    squares += frame.mul(frame);
  }
  const cv::Mat average = sum / frames;
  const cv::Mat variance = (squares - average.mul(sum)) / (frames - 1);
  FieldStatistics statistics;
  cv::Scalar mean, deviation;
  cv::meanStdDev(average, mean, deviation);
  statistics.mean_dn = mean[0];
  statistics.temporal_dn2 = cv::mean(variance)[0];
  statistics.spatial_dn2 = std::max(0.0, deviation[0] * deviation[0] - statistics.temporal_dn2 / frames);
  const double noise_dn2 = statistics.temporal_dn2;
  statistics.weight = noise_dn2 < kResolved_dn2 ? 0 : (frames - 1) / (noise_dn2 * noise_dn2);
  return statistics;
}

struct Line {
  double slope, at_zero;
};

/// Temporal variance over mean above the dark.
Line fitted(const std::vector<FieldStatistics>& fields, double dark_dn) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const FieldStatistics& f : fields) {
    const double light_dn = f.mean_dn - dark_dn;
    w += f.weight;
    x += f.weight * light_dn;
    y += f.weight * f.temporal_dn2;
    xx += f.weight * light_dn * light_dn;
    xy += f.weight * light_dn * f.temporal_dn2;
  }
  const double slope = (w * xy - x * y) / (w * xx - x * x);
  return {slope, (y - slope * x) / w};
}

}  // namespace

PhotonTransfer photon_transfer(const FlatField& dark, const FlatField& bright,
                               const std::vector<FlatField>& others) {
  std::vector<FieldStatistics> fields = {statistics_of(dark), statistics_of(bright)};
  for (const FlatField& field : others) fields.push_back(statistics_of(field));
  const FieldStatistics &in_dark = fields[0], &in_light = fields[1];
  const double light_dn = in_light.mean_dn - in_dark.mean_dn;
  if (!(light_dn > 0)) throw std::invalid_argument("photon_transfer: no light in the bright field");

  const Line line = fitted(fields, in_dark.mean_dn);
  PhotonTransfer result;
  result.gain_dn_per_e = line.slope;
  result.read_noise_e = std::sqrt(std::max(0.0, line.at_zero - kQuantisation_dn2)) / line.slope;
  result.prnu_percent = 100 * std::sqrt(std::max(0.0, in_light.spatial_dn2 - in_dark.spatial_dn2)) / light_dn;
  result.dsnu_e = std::sqrt(in_dark.spatial_dn2) / line.slope;
  result.black_dn = in_dark.mean_dn;
  return result;
}

}  // namespace groundloop::sim
