#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/mapping/mapper.h"

namespace groundloop::slam {

/// One point of the cloud, in the left camera that saw it.
struct SeenPoint {
  Eigen::Vector3f p_left = Eigen::Vector3f::Zero();
  float sigma_m = 0;  ///< standard deviation along its ray
  uint8_t grey = 0;
};

/// A key frame's sight, tied to a place of the map whose corrections it follows.
struct Look {
  int key_frame = 0;
  int place = 0;
  Pose T_place_left = Pose::Identity();
  SharedObservations observations;
  std::vector<SeenPoint> points;  ///< that it added to the cloud
};

/// The global map of the looks that are kept, following the corrections of their places.
///
/// A look enters the grid where its place is known to be. When one has moved by half a cell since, the grid
/// is built anew from all looks, in the order of their key frames: a few of them at every call, so that no
/// call takes long, in a second grid that takes over once it is complete. A place keeps its newest looks
/// only: memory grows with the mapped area, not with time, and what has left a place is forgotten.
class MapBuilder {
 public:
  /// @param looks_kept  of one place, at least 1
  MapBuilder(const StereoRig& rig, const FlogOptions& options, int looks_kept);

  /// Adds a look and draws it, and goes on with a grid that is being built anew.
  /// @param T_map_place  pose of every place as known now, by number
  void add(Look look, const std::vector<Pose>& T_map_place);

  /// Adds a look without drawing it.
  void keep(Look look);
  /// Draws looks that are kept and not drawn yet, a few at most, and goes on with a grid that is being built
  /// anew.
  /// @return whether the grid holds all that is kept
  bool draw(const std::vector<Pose>& T_map_place, size_t looks);

  /// Builds the whole grid at the given poses.
  /// @param by_two  with a second thread; the grid is the same
  void complete(const std::vector<Pose>& T_map_place, bool by_two);

  const FlogGrid& grid() const { return current_.mapper.grid(); }
  /// The looks that are kept, in the order of their key frames.
  const std::vector<Look>& looks() const { return looks_; }

 private:
  /// A grid, and where the first of looks_ entered it.
  struct Grid {
    Mapper mapper;
    std::vector<Pose> T_map_left;
  };

  void forget_oldest(int place);
  bool has_moved(const std::vector<Pose>& T_map_place) const;
  void fill(Grid& grid, const std::vector<Pose>& T_map_place, size_t looks) const;

  StereoRig rig_;
  FlogOptions options_;
  int looks_kept_;
  std::vector<Look> looks_;
  Grid current_;
  std::optional<Grid> next_;
};

}  // namespace groundloop::slam
