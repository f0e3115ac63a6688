#pragma once

#include <vector>

#include "slam/types/config.h"

namespace groundloop::slam {

/// The fuzzy occupancy grid (paper section 2.4). YAML: slam.mapping
struct FlogOptions {
  double cell_m = 0.05;
  /// Heights above the floor between which the layers lie; the first and last bound the mapped band. What is
  /// below the first is floor, or the mirror image of something in a shiny floor.
  std::vector<double> layer_heights_m = {0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0};
  /// True: the 2-D map is made of the layers. False: one grid for the whole band, as in the paper, in which a
  /// view below a desk speaks against the desk.
  bool fuse_layers = true;
  /// True: where one ray of a key frame ends, the others that cross the cell above or below speak less for
  /// emptiness: mu_E <- mu_E (1 - mu_O). Thin things, as the edge of a desk, are lost otherwise.
  bool ends_deny_empty = true;

  double k_empty = 0.60;       ///< largest emptiness one key frame can add to a cell
  double k_occupied = 0.95;    ///< largest occupancy one key frame can add to a cell
  double k_confidence = 0.95;  ///< largest confidence one key frame can add to a cell
  double lambda = 1;  ///< how much a local map revises the contrary belief of the global one; 0: plain union

  double sigma_disparity_px = 0.15;  ///< noise of disparities that come without: width of the occupied band
  double sigma_max_m = 0.15;         ///< points lose their say about the range where depth noise reaches this
  double max_range_m = 12.0;         ///< horizontal; points farther away are left out

  template <class Archive>
  void visit(Archive& a) {
    a("cell_m", cell_m, {.min = 0.005, .max = 1});
    a("layer_heights_m", layer_heights_m, {.min = -10, .max = 100});
    a("fuse_layers", fuse_layers);
    a("ends_deny_empty", ends_deny_empty);
    a("k_empty", k_empty, {.min = 0, .max = 1});
    a("k_occupied", k_occupied, {.min = 0, .max = 1});
    a("k_confidence", k_confidence, {.min = 0.001, .max = 1});
    a("lambda", lambda, {.min = 0, .max = 1});
    a("sigma_disparity_px", sigma_disparity_px, {.min = 0.001, .max = 10});
    a("sigma_max_m", sigma_max_m, {.min = 0.001, .max = 100});
    a("max_range_m", max_range_m, {.min = 0.1, .max = 200});
  }
  void check(ConfigReader& reader) const;

  int layer_count() const { return static_cast<int>(layer_heights_m.size()) - 1; }
};

}  // namespace groundloop::slam
