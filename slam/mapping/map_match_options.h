#pragma once

#include "slam/types/config.h"

namespace groundloop::slam {

/// Registration of the local occupancy map to the global one. YAML: slam.map_match
struct MapMatchOptions {
  bool enabled = true;
  int key_frames = 15;            ///< the newest so many make the local map
  int min_age_frames = 150;       ///< younger looks are not in the global map that is matched against
  double min_prior_sigma_m = 0.02;  ///< a pose known better than this gains nothing from a match
  double search_sigma = 3;        ///< half the search window, in standard deviations of what is known before
  double max_window_m = 0.5;      ///< half the search window, at most
  double max_window_deg = 10;     ///< half the search window, at most
  int min_cells = 80;             ///< occupied cells that the local map must have
  double min_overlap = 0.5;       ///< share of them that the global map must know
  double min_agreement = 0.6;     ///< share of those known that must be occupied there as well
  double max_second_score = 0.8;  ///< score of the second best peak, relative to the best
  double max_sigma_m = 0.04;      ///< position uncertainty of a match in its worst direction
  double max_sigma_deg = 0.4;     ///< heading uncertainty of a match
  double level_sigma_m = 0.005;   ///< of the body's height over the floor, which is flat where the maps match
  double level_sigma_deg = 0.2;   ///< of the body's roll and pitch there

  template <class Archive>
  void visit(Archive& a) {
    a("enabled", enabled);
    a("key_frames", key_frames, {.min = 1, .max = 1000});
    a("min_age_frames", min_age_frames, {.min = 1, .max = 1000000});
    a("min_prior_sigma_m", min_prior_sigma_m, {.min = 0, .max = 10});
    a("search_sigma", search_sigma, {.min = 0.1, .max = 100});
    a("max_window_m", max_window_m, {.min = 0.01, .max = 20});
    a("max_window_deg", max_window_deg, {.min = 0.1, .max = 180});
    a("min_cells", min_cells, {.min = 3, .max = 1000000});
    a("min_overlap", min_overlap, {.min = 0, .max = 1});
    a("min_agreement", min_agreement, {.min = 0, .max = 1});
    a("max_second_score", max_second_score, {.min = 0.5, .max = 1});
    a("max_sigma_m", max_sigma_m, {.min = 1e-4, .max = 10});
    a("max_sigma_deg", max_sigma_deg, {.min = 1e-3, .max = 180});
    a("level_sigma_m", level_sigma_m, {.min = 1e-5, .max = 10});
    a("level_sigma_deg", level_sigma_deg, {.min = 1e-3, .max = 180});
  }
};

}  // namespace groundloop::slam
