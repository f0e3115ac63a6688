#include "slam/loop/place_index.h"

#include <algorithm>
#include <cmath>

#include "slam/loop/descriptors.h"
#include "slam/types/counter_random.h"

namespace groundloop::slam {

PlaceIndex::PlaceIndex() {
  constexpr uint64_t kSeed = 0x706C616365;
  for (int table = 0; table < kTables; ++table) {
    // the first bits of a shuffled 0..255: no bit twice in one table
    std::array<uint8_t, 256> order;
    for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<uint8_t>(i);
    for (int i = 0; i < kKeyBits; ++i) {
      const uint64_t bits = random_bits(kSeed, static_cast<uint64_t>(table), static_cast<uint64_t>(i));
      std::swap(order[i], order[i + random_index(bits, static_cast<uint32_t>(256 - i))]);
      bits_[table][i] = order[i];
    }
    newest_[table].assign(size_t{1} << kKeyBits, -1);
  }
}

uint32_t PlaceIndex::key(int table, const Descriptor& descriptor) const {
  uint32_t key = 0;
  for (const uint8_t bit : bits_[table]) {
    key = (key << 1) | static_cast<uint32_t>((descriptor[bit / 64] >> (bit % 64)) & 1);
  }
  return key;
}

void PlaceIndex::add(const std::vector<Keypoint>& keypoints) {
  for (const Keypoint& keypoint : keypoints) {
    const auto entry = static_cast<int32_t>(descriptors_.size());
    descriptors_.push_back(keypoint.descriptor);
    view_.push_back(views_);
    seen_.push_back(0);
    for (int table = 0; table < kTables; ++table) {
      int32_t& newest = newest_[table][key(table, keypoint.descriptor)];
      older_[table].push_back(newest);
      newest = entry;
    }
  }
  ++views_;
  voted_.push_back(0);
}

/// Leaves in found_ the views that have a descriptor like this one.
void PlaceIndex::look_up(const Descriptor& descriptor, int views) {
  found_.clear();
  ++look_up_;
  for (int table = 0; table < kTables; ++table) {
    int32_t entry = newest_[table][key(table, descriptor)];
    for (int n = 0; entry >= 0 && n < kChain; entry = older_[table][entry]) {
      const int view = view_[entry];
      if (view >= views) continue;
      ++n;
      if (seen_[entry] == look_up_ || voted_[view] == look_up_) continue;
      seen_[entry] = look_up_;
      if (distance(descriptor, descriptors_[entry]) > kMaxDistance) continue;
      voted_[view] = look_up_;
      found_.push_back(view);
    }
  }
}

void PlaceIndex::query(const std::vector<Keypoint>& keypoints, int views, int wanted,
                       std::vector<PlaceCandidate>& candidates) {
  candidates.clear();
  score_.assign(static_cast<size_t>(views), 0);
  for (const Keypoint& keypoint : keypoints) {
    look_up(keypoint.descriptor, views);
    if (found_.empty()) continue;
    // what few views have says more (inverse document frequency)
    const double weight = std::log(1 + static_cast<double>(views) / static_cast<double>(found_.size()));
    for (const int view : found_) score_[view] += weight;
  }
  for (int view = 0; view < views; ++view) {
    if (score_[view] > 0) candidates.push_back({view, score_[view]});
  }
  std::sort(candidates.begin(), candidates.end(), [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.score != b.score ? a.score > b.score : a.view < b.view;
  });
  if (static_cast<int>(candidates.size()) > wanted) candidates.resize(static_cast<size_t>(wanted));
}

}  // namespace groundloop::slam
