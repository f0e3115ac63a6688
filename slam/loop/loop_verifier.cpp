#include "slam/loop/loop_verifier.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>

#include "slam/stereo/disparity.h"
#include "slam/types/stereo_uncertainty.h"

namespace groundloop::slam {
namespace {

constexpr double kMinDepth_m = 0.1;
constexpr double kBorder_px = 10;  // a window nearer to the border is not expected to be found
constexpr double kDegree = std::numbers::pi / 180;
constexpr int kMaxDistance = 80;  // bits, of a descriptor match
constexpr double kRatio = 0.85;
constexpr double kGoodPrediction_px = 8;  // what KLT from a predicted position copes with
constexpr double kAgreement_px = 2;
constexpr double kExpectedResidual = 1.25;  // of noise and depth, in units of sigma_px
constexpr double kFewKnowLess = 4;          // of the covariance: few landmarks share more of their errors
constexpr int kColumns = 8, kRows = 6;

/// Rough points, rough measurements: corners of coarse pyramid levels with block-matching depth.
RegistrationOptions coarse_options(RegistrationOptions options) {
  options.cost = RegistrationCost::kReprojection;
  options.sigma_px = 1;
  options.inlier_gate_px = 6;
  options.ransac_iterations = 500;
  options.min_inliers = 10;
  options.min_inlier_ratio = 0.1;
  return options;
}

/// A link is measured once and kept: the tracker's haste does not pay.
KltOptions patient(KltOptions options) {
  options.converged_px = std::min(options.converged_px, 0.015);
  return options;
}

RegistrationOptions fine_options(RegistrationOptions options) {
  options.cost = RegistrationCost::kReprojection;
  options.inlier_gate_px = kAgreement_px;
  options.ransac_iterations = 50;
  options.min_inliers = 6;
  options.min_inlier_ratio = 0;
  return options;
}

/// Where the pose is known already, chance and places that look alike have little room: fewer landmarks will
/// do, and what they say must be nearer to what is known.
LoopOptions eased(LoopOptions options) {
  const double ease = options.predicted_ease;
  options.min_inliers = std::max(6, static_cast<int>(std::lround(ease * options.min_inliers)));
  options.min_inlier_ratio *= ease;
  options.min_reverse_ratio *= ease;
  options.max_sigma_ratio /= ease;
  options.max_sigma_deg /= ease;
  options.margin_m *= ease;
  options.margin_deg *= ease;
  return options;
}

/// A covariance with the options' margins added.
Matrix6d with_margins(Matrix6d covariance, const LoopOptions& options) {
  const double margin_rad = options.margin_deg * kDegree;
  covariance.topLeftCorner<3, 3>().diagonal().array() += options.margin_m * options.margin_m;
  covariance.bottomRightCorner<3, 3>().diagonal().array() += margin_rad * margin_rad;
  return covariance;
}

/// What few landmarks leave open is taken as predicted, up to the margins. The link claims no more for it:
/// its covariance remains that of the landmarks.
void fill_in(const PosePrediction& prediction, const LoopOptions& options, LoopLink& link) {
  const Vector6d to_prediction = se3_log(link.T_from_to.inverse() * prediction.T_from_to);
  const Matrix6d both = link.covariance + with_margins(prediction.covariance, options);
  link.T_from_to = link.T_from_to * se3_exp(link.covariance * both.ldlt().solve(to_prediction));
}

/// Whether in some direction a measurement is less uncertain than what is known already.
bool tells_more(const Matrix6d& measured, const Matrix6d& known) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratio(known, measured, Eigen::EigenvaluesOnly);
  return ratio.eigenvalues().maxCoeff() > 1;
}

/// Something nearer is seen where the landmark should be.
bool hidden(const StereoRig& rig, const cv::Mat& half_disparity, const Eigen::Vector3d& uvu) {
  const auto seen_px =
      disparity_around(half_disparity, static_cast<float>(uvu.x()), static_cast<float>(uvu.y()));
  const double expected_px = uvu.x() - uvu.z() - rig.disparity_at_infinity_px();
  return seen_px && *seen_px - rig.disparity_at_infinity_px() > 1.15 * expected_px + 2;
}

/// Of a view with landmarks.
double median_depth_m(const StoredView& view) {
  std::vector<float> depths_m;
  for (const Landmark& landmark : view.landmarks) depths_m.push_back(landmark.depth_m);
  const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
  std::nth_element(depths_m.begin(), middle, depths_m.end());
  return *middle;
}

/// At most `wanted` of n, evenly spread over the order in which they are kept.
int stride_of(size_t n, int wanted) {
  return std::max(1, static_cast<int>((n + static_cast<size_t>(wanted) - 1) / static_cast<size_t>(wanted)));
}

}  // namespace

Eigen::Matrix2d predicted_shape(const StereoRig& rig, const Pose& T_to_from, const Eigen::Vector3d& p_from,
                                double offset_m) {
  // On the plane n.p = n.p_from with n along the ray, p = r(u, v) (n.p_from) / (n.r).
  const Eigen::Vector3d r = p_from / p_from.z(), n = r.normalized();
  const double depth = n.dot(p_from), n_r = n.dot(r);
  Eigen::Matrix<double, 3, 2> dp;  // by the normalised image coordinates
  for (int k = 0; k < 2; ++k) {
    dp.col(k) = depth / n_r * (Eigen::Vector3d::Unit(k) - r * (n(k) / n_r));
  }
  dp.col(0) /= rig.fx_px;
  dp.col(1) /= rig.fy_px;
  Eigen::Vector3d p_to = T_to_from * p_from;
  p_to.x() -= offset_m;
  Eigen::Matrix<double, 2, 3> J;
  J << rig.fx_px / p_to.z(), 0, -rig.fx_px * p_to.x() / (p_to.z() * p_to.z()),  //
      0, rig.fy_px / p_to.z(), -rig.fy_px * p_to.y() / (p_to.z() * p_to.z());
  return J * T_to_from.linear() * dp;
}

LoopVerifier::LoopVerifier(const StereoRig& rig, const LoopOptions& options, const KltOptions& klt,
                           const StereoOptions& stereo, const RegistrationOptions& registration)
    : rig_(rig),
      options_(options),
      eased_(eased(options)),
      klt_(patient(klt)),
      matcher_(rig, stereo, klt_),
      sigma_px_(registration.sigma_px),
      coarse_(rig, coarse_options(registration)),
      fine_(rig, fine_options(registration)) {}

Verification LoopVerifier::verify(const StoredView& stored, const CurrentView& current,
                                  const std::optional<PosePrediction>& prediction, uint64_t seed) {
  stored_pyramid_.build(stored.grey, klt_.levels);
  Verification found;
  const LoopOptions* needed = &options_;
  if (prediction && precise_enough(stored, *prediction)) {
    // Odometry knows more of what was in sight all the time than a few landmarks do.
    found = refine(stored, current, prediction->T_from_to, seed, stored.was_away ? eased_ : options_);
    if (found.accepted && !refusal(stored, found, options_).empty()) {
      needed = &eased_;
      found.link.covariance *= kFewKnowLess;
    }
  }
  if (!found.accepted) {
    std::string message;
    if (const auto T_from_to = coarse_pose(stored, current, seed, message)) {
      found = refine(stored, current, *T_from_to, seed, options_);
    } else if (found.message == Verification().message) {
      found.message = message;
    }
  }
  if (found.accepted && prediction) compare(*prediction, stored.was_away, *needed, found);
  return found;
}

/// Refuses a link that contradicts what is known, or tells nothing new.
void LoopVerifier::compare(const PosePrediction& prediction, bool was_away, const LoopOptions& needed,
                           Verification& found) const {
  const double sigma = contradiction_sigma(prediction, {found.link.T_from_to, found.link.covariance}, needed);
  if (!(sigma <= needed.gate_sigma)) {
    found.accepted = false;
    found.message =
        fmt::format("{:.1f} sigma from the predicted pose, {:.1f} allowed", sigma, options_.gate_sigma);
  } else if (!was_away && !tells_more(found.link.covariance, prediction.covariance)) {
    found.accepted = false;
    found.message = "tells less than odometry does";
  } else if (!was_away || &needed == &eased_) {
    fill_in(prediction, eased_, found.link);
  }
}

bool LoopVerifier::precise_enough(const StoredView& stored, const PosePrediction& prediction) const {
  if (stored.landmarks.empty()) return false;
  const double sigma_m = std::sqrt(prediction.covariance.topLeftCorner<3, 3>().trace());
  const double sigma_rad = std::sqrt(prediction.covariance.bottomRightCorner<3, 3>().trace());
  return rig_.fx_px * (sigma_m / median_depth_m(stored) + sigma_rad) < kGoodPrediction_px;
}

std::optional<Pose> LoopVerifier::coarse_pose(const StoredView& stored, const CurrentView& current,
                                              uint64_t seed, std::string& message) {
  match_descriptors(stored.keypoints, current.view.keypoints, kMaxDistance, kRatio, matches_);
  coarse_pairs_.clear();
  for (const DescriptorMatch& match : matches_) {
    const Eigen::Vector3d uvu = stored.keypoints[static_cast<size_t>(match.a)].uvu_px.cast<double>();
    const auto p_from = rig_.triangulate(uvu);
    if (!p_from) continue;
    coarse_pairs_.push_back({*p_from, point_covariance(rig_, uvu, 1),
                             current.view.keypoints[static_cast<size_t>(match.b)].uvu_px.cast<double>()});
  }
  coarse_.align(coarse_pairs_, Pose::Identity(), seed, registered_);
  if (registered_.usable) return registered_.T_from_to;
  message = "descriptors: " + registered_.message;
  return std::nullopt;
}

Verification LoopVerifier::refine(const StoredView& stored, const CurrentView& current, const Pose& T_coarse,
                                  uint64_t seed, const LoopOptions& needed) {
  Verification found;
  Pose T_from_to = T_coarse;
  // From the coarse pose, then from that of the first search, which finds more and knows what is hidden.
  for (int pass = 0; pass < 2; ++pass) {
    find_landmarks(stored, current, T_from_to, search_);
    fine_.align(search_.pairs, T_from_to, seed, registered_);
    found.expected = search_.expected;
    found.link.inliers = registered_.inliers;
    found.inlier_ratio = static_cast<double>(registered_.inliers) / std::max(search_.expected, 1);
    if (!registered_.usable) {
      found.message = registered_.message;
      return found;
    }
    const bool done = found.inlier_ratio > 0.7;
    T_from_to = registered_.T_from_to;
    if (done) break;
  }
  found.link = {LinkKind::kLandmarks,   stored.index,        current.view.index,     registered_.T_from_to,
                registered_.covariance, registered_.inliers, registered_.residual_px};
  // Misfits beyond the noise are of windows seen from another side: they share causes, so more landmarks do
  // not average them out as independent noise.
  found.link.covariance *= std::max(1.0, registered_.residual_px / (kExpectedResidual * sigma_px_));
  found.reverse_ratio = reverse_ratio(current, T_from_to);
  found.message = refusal(stored, found, needed);
  found.accepted = found.message.empty();
  return found;
}

/// Where landmarks should be seen from another camera, those of them that should be. At most `wanted`, evenly
/// spread over the order in which they are kept.
void LoopVerifier::choose_visible(const std::vector<Landmark>& landmarks, const Pose& T_other_own,
                                  bool right_too, int wanted, std::vector<Visible>& visible) const {
  const auto inside = [this](double u, double v) {
    return u > kBorder_px && v > kBorder_px && u < rig_.width_px - kBorder_px &&
           v < rig_.height_px - kBorder_px;
  };
  const auto limit = static_cast<float>(klt_.max_scale * klt_.max_scale);
  visible.clear();
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d p_own = point_of(rig_, landmark), p_other = T_other_own * p_own;
    if (p_other.z() < kMinDepth_m) continue;
    const Eigen::Vector3d uvu = rig_.project(p_other);
    if (!inside(uvu.x(), uvu.y()) || (right_too && !inside(uvu.z(), uvu.y()))) continue;
    const Eigen::Matrix2f A = predicted_shape(rig_, T_other_own, p_own, 0).cast<float>();
    if (A.determinant() < limit && A.determinant() > 1 / limit) visible.push_back({&landmark, p_own, uvu, A});
  }
  const auto step = static_cast<size_t>(stride_of(visible.size(), wanted));
  size_t kept = 0;
  for (size_t i = 0; i < visible.size(); i += step) visible[kept++] = visible[i];
  visible.resize(kept);
}

void LoopVerifier::find_landmarks(const StoredView& stored, const CurrentView& current, const Pose& T_from_to,
                                  Search& search) {
  search.pairs.clear();
  search.expected = 0;
  const Pose T_to_from = T_from_to.inverse();
  choose_visible(stored.landmarks, T_to_from, true, options_.landmarks, visible_);
  for (const Visible& seen : visible_) {
    if (hidden(rig_, current.half_disparity, seen.uvu_px)) continue;
    if (!patch_.take(stored_pyramid_, seen.landmark->uv_px, klt_.levels)) continue;
    ++search.expected;
    AffineState left, right;
    if (!find(current.left, seen.uvu_px.head<2>().cast<float>(), seen.A, left)) continue;
    Eigen::Vector2f at_right = Eigen::Vector2d(seen.uvu_px.z(), seen.uvu_px.y()).cast<float>();
    at_right += current.right_lag.shift_px(rig_, T_to_from * seen.p_own);
    const Eigen::Matrix2f A_right =
        predicted_shape(rig_, T_to_from, seen.p_own, rig_.baseline_m).cast<float>();
    if (!find(current.right, at_right, A_right, right)) continue;
    right.uv_px -= current.right_lag.shift_px(rig_, left.uv_px, right.uv_px);
    if (!matcher_.plausible(left.uv_px, right.uv_px)) continue;
    const double sigma_m = seen.landmark->sigma_m;
    const Eigen::Vector3d ray = seen.p_own / seen.p_own.z();
    search.pairs.push_back({seen.p_own, sigma_m * sigma_m * ray * ray.transpose(),
                            optimal_measurement(left.uv_px, right.uv_px)});
  }
}

/// Share of the current landmarks that should be seen in the stored image and are found there where the pose
/// puts them. A picture or piece of furniture that another place has too fails here: its surroundings differ.
double LoopVerifier::reverse_ratio(const CurrentView& current, const Pose& T_from_to) {
  int expected = 0, found = 0;
  choose_visible(current.view.landmarks, T_from_to, false, options_.landmarks / 2, visible_);
  for (const Visible& seen : visible_) {
    if (!patch_.take(current.left, seen.landmark->uv_px, klt_.levels)) continue;
    ++expected;
    AffineState state;
    if (!find(stored_pyramid_, seen.uvu_px.head<2>().cast<float>(), seen.A, state)) continue;
    if ((state.uv_px.cast<double>() - seen.uvu_px.head<2>()).norm() < kAgreement_px) ++found;
  }
  return expected > 0 ? static_cast<double>(found) / expected : 0;
}

bool LoopVerifier::find(const ImagePyramid& image, const Eigen::Vector2f& uv_px, const Eigen::Matrix2f& A,
                        AffineState& state) const {
  for (const int start_level : {1, patch_.levels - 1}) {
    state.uv_px = uv_px;
    state.A = A;
    if (track_affine(patch_, image, klt_, start_level, state) == KltStatus::kTracked) return true;
    if (patch_.levels <= 2) break;
  }
  return false;
}

int LoopVerifier::occupied_cells(const Search& search) const {
  std::bitset<kColumns * kRows> cells;
  for (size_t i = 0; i < search.pairs.size(); ++i) {
    if (registered_.inlier[i] == 0) continue;
    const Eigen::Vector3d& uvu = search.pairs[i].uvu_to;
    const int column = static_cast<int>(uvu.x() * kColumns / rig_.width_px);
    const int row = static_cast<int>(uvu.y() * kRows / rig_.height_px);
    const int cell = std::clamp(row, 0, kRows - 1) * kColumns + std::clamp(column, 0, kColumns - 1);
    cells.set(static_cast<size_t>(cell));
  }
  return static_cast<int>(cells.count());
}

/// What speaks against the link, empty when nothing does.
std::string LoopVerifier::refusal(const StoredView& stored, const Verification& found,
                                  const LoopOptions& needed) const {
  if (found.link.inliers < needed.min_inliers) {
    return fmt::format("{} landmarks agree, {} needed", found.link.inliers, needed.min_inliers);
  }
  if (found.inlier_ratio < needed.min_inlier_ratio) {
    return fmt::format("{} of {} stored landmarks found, {:.0f} % needed", found.link.inliers, found.expected,
                       100 * needed.min_inlier_ratio);
  }
  if (found.reverse_ratio < needed.min_reverse_ratio) {
    return fmt::format("{:.0f} % of the current landmarks found in the stored view, {:.0f} % needed",
                       100 * found.reverse_ratio, 100 * needed.min_reverse_ratio);
  }
  const int cells = occupied_cells(search_);
  if (cells < needed.min_cells) {
    return fmt::format("landmarks in {} of {} parts of the image, {} needed", cells, kColumns * kRows,
                       needed.min_cells);
  }
  const auto largest_sigma = [](const Eigen::Matrix3d& covariance) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues().z());
  };
  const double sigma_m = largest_sigma(found.link.covariance.topLeftCorner<3, 3>());
  const double sigma_deg = largest_sigma(found.link.covariance.bottomRightCorner<3, 3>()) / kDegree;
  if (sigma_m > needed.max_sigma_ratio * median_depth_m(stored) || sigma_deg > needed.max_sigma_deg) {
    return fmt::format("uncertain by {:.3f} m and {:.2f} deg", sigma_m, sigma_deg);
  }
  return {};
}

double contradiction_sigma(const PosePrediction& a, const PosePrediction& b, const LoopOptions& options) {
  const Vector6d error = se3_log(a.T_from_to.inverse() * b.T_from_to);
  const Matrix6d covariance = with_margins(a.covariance + b.covariance, options);
  return std::sqrt(error.dot(covariance.ldlt().solve(error)));
}

}  // namespace groundloop::slam
