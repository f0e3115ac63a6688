#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace groundloop::sim {

/// Images (CV_8UC1, two or more) of an evenly lit field, all at one light and one setting.
using FlatField = std::vector<cv::Mat>;

/// What flat fields say of the sensor that took them, in the terms of EMVA 1288.
struct PhotonTransfer {
  double gain_dn_per_e = 0;  ///< K, with whatever gain was set
  double read_noise_e = 0;   ///< temporal noise in the dark, without that of quantisation
  double prnu_percent = 0;
  double dsnu_e = 0;
  double black_dn = 0;
};

/// The photon transfer method (EMVA 1288 release 3.1, sections 6 to 8): temporal variance over mean is a
/// line of slope K, since the variance of a number of electrons is that number; where it meets the dark, it
/// is the read noise's variance and the 1/12 of quantisation. Averages over frames leave the pixels' own
/// pattern: in the dark DSNU, and what light adds to it PRNU. Fields with a temporal variance below 0.3 DN^2
/// are left out of the line: there, rounding hides the noise.
/// @param dark    many frames without light, black level high enough that nothing is cut at 0
/// @param bright  many frames at about half of the range
/// @param others  further levels, at most 0.7 of the range. When the dark noise is less than 0.6 DN, several
///                low ones are needed, with means at different fractions of a grey level, to average out the
///                steps of rounding
/// @throws std::invalid_argument when a field has fewer than two frames or there is no light in `bright`
PhotonTransfer photon_transfer(const FlatField& dark, const FlatField& bright,
                               const std::vector<FlatField>& others);

}  // namespace groundloop::sim
