#include "slam/stereo/lag_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace groundloop::slam {
namespace {

constexpr size_t kFewest = 30;       // matches
constexpr double kMostAgree = 0.5;   // mean weight of a pair that is to be believed
constexpr double kRow_px = 0.1;      // least standard deviation of a row difference
constexpr double kWide_px = 0.3;     // differences farther off lose weight
constexpr double kPlace_px = 0.3;    // what a calibration is off by in the rows, at the direction 1
constexpr double kTurn_px = 0.1;     // what it is turned by more than a pair before
constexpr double kAnyLag = 1e-10;    // information on the lag beforehand: none
constexpr double kLikeness = 0.01;   // correlation of the errors of two matches
constexpr int kRounds = 2;           // of reweighting
constexpr double kTold_s = 0.01;     // a pair that tells less has too little flow
constexpr double kSigmas = 5;        // beyond chance
constexpr double kLeast_s = 0.002;   // less does no harm
constexpr double kDrift_s = 0.0005;  // of a lag from pair to pair

double squared(double x) { return x * x; }

}  // namespace

/// Reweighted least squares with
/// row difference = a + b x + c y + (lag - known lag) flow + aside x y + up y y.
std::optional<LagEstimate::OfPair> LagEstimate::fit(const std::vector<LagSight>& sights) const {
  const double place = squared(kRow_px / kPlace_px), turn = squared(kRow_px / kTurn_px);
  const Vector6d known{place, place, place, kAnyLag, turn, turn};
  const Vector6d before{0, 0, 0, 0, turned_px_.x(), turned_px_.y()};
  Vector6d fitted = before;
  Matrix6d H;
  double weights = 0, variance_px2 = 0;
  for (int round = 0; round < kRounds; ++round) {
    H = known.asDiagonal();
    Vector6d b = known.cwiseProduct(before);
    weights = variance_px2 = 0;
    for (const LagSight& sight : sights) {
      const double x = sight.at.x(), y = sight.at.y();
      const Vector6d J{1, x, y, sight.row_flow_px_per_s, x * y, y * y};
      const double off_px = sight.row_difference_px - J.dot(fitted);
      const double weight = 1 / (1 + squared(off_px / kWide_px));
      H.noalias() += (weight * J) * J.transpose();
      b.noalias() += weight * sight.row_difference_px * J;
      weights += weight;
      variance_px2 += weight * squared(off_px);
    }
    fitted = H.ldlt().solve(b);
  }
  const auto matches = static_cast<double>(sights.size());
  if (weights < kMostAgree * matches) return std::nullopt;
  variance_px2 = std::max(variance_px2 / weights, squared(kRow_px));
  const double noise_s2 = variance_px2 * H.inverse()(3, 3);
  return OfPair{late_s() + fitted(3), noise_s2, kLikeness * matches * noise_s2, fitted.tail<2>()};
}

void LagEstimate::observe(const std::vector<LagSight>& sights) {
  if (!wanted() || sights.size() < kFewest) return;
  const std::optional<OfPair> pair = fit(sights);
  if (!pair) return;
  turned_px_ = pair->turned_px;
  if (!(pair->noise_s2 + pair->calibration_s2 < squared(kTold_s))) return;
  take(*pair);
  const double sigma_s = std::sqrt(noise_s2_ + calibration_s2_);
  const double least_s = std::max(kLeast_s, kSigmas * sigma_s) * (claimed_ ? 0.5 : 1);
  claimed_ = std::abs(late_s_) > least_s && std::abs(late_s_) <= options_.max_right_late_s;
}

/// The mean of the newest pairs; a pair that is another by far begins a new one.
void LagEstimate::take(const OfPair& pair) {
  noise_s2_ += squared(kDrift_s);
  const double off_s = pair.late_s - late_s_;
  const bool other = squared(off_s) > squared(kSigmas) * (noise_s2_ + pair.noise_s2);
  const double gain = other ? 1 : noise_s2_ / (noise_s2_ + pair.noise_s2);
  late_s_ += gain * off_s;
  noise_s2_ = gain * pair.noise_s2;
  calibration_s2_ += gain * (pair.calibration_s2 - calibration_s2_);
}

}  // namespace groundloop::slam
