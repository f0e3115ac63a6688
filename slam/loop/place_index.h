#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slam/loop/stored_view.h"

namespace groundloop::slam {

/// A stored view that looks like the one asked for.
struct PlaceCandidate {
  int view = 0;
  double score = 0;  ///< descriptors in common, each weighted by how few views have it
};

/// Which stored views share descriptors with a new one: locality-sensitive hashing by sampled bits (Indyk and
/// Motwani, STOC 1998), kTables tables of kKeyBits bits each. Grows by insertion and is never rebuilt; the
/// sampled bits are a function of the table alone, so that the answer depends on the views only.
///
/// Cost for V views of n descriptors: 68 V n bytes, and 4 MB of empty tables; a query looks at most at
/// n kTables kChain descriptors, however alike the views are.
class PlaceIndex {
 public:
  PlaceIndex();

  /// Adds a view; views are numbered 0, 1, 2, ... in the order in which they come.
  void add(const std::vector<Keypoint>& keypoints);
  int views() const { return views_; }

  /// @param views  only the first so many views are asked
  /// @param candidates  overwritten; best first, at most `wanted`
  void query(const std::vector<Keypoint>& keypoints, int views, int wanted,
             std::vector<PlaceCandidate>& candidates);

 private:
  static constexpr int kTables = 8;
  static constexpr int kKeyBits = 16;
  static constexpr int kChain = 64;        ///< newest entries of a bucket that are looked at
  static constexpr int kMaxDistance = 64;  ///< bits; descriptors farther apart have nothing in common

  uint32_t key(int table, const Descriptor& descriptor) const;
  void look_up(const Descriptor& descriptor, int views);

  std::array<std::array<uint8_t, kKeyBits>, kTables> bits_;
  std::array<std::vector<int32_t>, kTables> newest_;  ///< by key: last entry, -1 when empty
  std::array<std::vector<int32_t>, kTables> older_;   ///< by entry: the one before it in its bucket
  std::vector<Descriptor> descriptors_;               ///< by entry
  std::vector<int32_t> view_;                         ///< by entry
  std::vector<uint32_t> seen_;                        ///< by entry: the look-up that met it last
  uint32_t look_up_ = 0;
  int views_ = 0;
  std::vector<int> found_;       ///< views that the last look-up found, once each
  std::vector<uint32_t> voted_;  ///< by view: the look-up that found it last
  std::vector<double> score_;    ///< by view
};

}  // namespace groundloop::slam
