#include "slam/pipeline/state_hash.h"

#include <cstring>

namespace groundloop::slam {
namespace {

class Fnv1a {
 public:
  template <class T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001B3ULL;
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace

uint64_t state_hash(const FrameResult& result) {
  Fnv1a hash;
  hash.add(result.index);
  hash.add(static_cast<int>(result.status));
  hash.add(result.segment);
  for (int i = 0; i < 12; ++i) hash.add(result.T_map_left.matrix()(i % 3, i / 3));
  for (const FeatureObservation& feature : result.features) {
    hash.add(feature.id);
    hash.add(feature.u_left_px);
    hash.add(feature.v_left_px);
    hash.add(feature.u_right_px);
    hash.add(feature.v_right_px);
    hash.add(feature.is_inlier);
  }
  return hash.value();
}

}  // namespace groundloop::slam
