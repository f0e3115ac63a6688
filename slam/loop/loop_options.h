#pragma once

#include "slam/types/config.h"

namespace groundloop::slam {

/// Options of place recognition by stored visual landmarks. YAML: slam.loop
struct LoopOptions {
  bool enabled = true;
  int descriptors = 400;           ///< described corners a key frame
  int landmarks = 240;             ///< looked for in the other images, at most, of those that should be there
  int candidates = 3;              ///< stored views tried a key frame
  int min_age_frames = 30;         ///< younger views, and those whose features are tracked yet, are no news
  int max_views = 1000;            ///< beyond it no further view is stored
  int min_inliers = 30;            ///< landmarks that agree on one motion
  double min_inlier_ratio = 0.45;  ///< of the stored landmarks that should be seen now
  double min_reverse_ratio = 0.4;  ///< of the current landmarks that should be in the stored image
  int min_cells = 8;               ///< of an 8 x 6 grid over the image, that hold an agreeing landmark
  double max_sigma_ratio =
      0.005;                    ///< position uncertainty of a link, relative to the landmarks' median depth
  double max_sigma_deg = 0.3;   ///< rotation uncertainty of a link
  double gate_sigma = 4.5;      ///< Mahalanobis distance to the predicted pose
  double margin_m = 0.05;       ///< added to the prediction's standard deviation
  double margin_deg = 1;        ///< added to the prediction's standard deviation
  double predicted_ease = 0.4;  ///< agreement needed where a place that was out of sight is expected to a few
                                ///< pixels, relative to the above
  int confirmations = 2;        ///< successive key frames that must agree where nothing is predicted
  double covered_ratio = 0.6;   ///< a view whose landmarks were found to this share is not stored again

  template <class Archive>
  void visit(Archive& a) {
    a("enabled", enabled);
    a("descriptors", descriptors, {.min = 20, .max = 5000});
    a("landmarks", landmarks, {.min = 20, .max = 5000});
    a("candidates", candidates, {.min = 1, .max = 100});
    a("min_age_frames", min_age_frames, {.min = 1, .max = 1000000});
    a("max_views", max_views, {.min = 1, .max = 1000000});
    a("min_inliers", min_inliers, {.min = 6, .max = 1000});
    a("min_inlier_ratio", min_inlier_ratio, {.min = 0, .max = 1});
    a("min_reverse_ratio", min_reverse_ratio, {.min = 0, .max = 1});
    a("min_cells", min_cells, {.min = 1, .max = 48});
    a("max_sigma_ratio", max_sigma_ratio, {.min = 1e-5, .max = 1});
    a("max_sigma_deg", max_sigma_deg, {.min = 1e-3, .max = 180});
    a("gate_sigma", gate_sigma, {.min = 1, .max = 100});
    a("margin_m", margin_m, {.min = 0, .max = 100});
    a("margin_deg", margin_deg, {.min = 0, .max = 180});
    a("predicted_ease", predicted_ease, {.min = 0.1, .max = 1});
    a("confirmations", confirmations, {.min = 1, .max = 10});
    a("covered_ratio", covered_ratio, {.min = 0, .max = 1});
  }
};

}  // namespace groundloop::slam
