#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <string>

#include "sim/cache/content_key.h"

namespace groundloop::sim {

inline constexpr uint64_t kCacheBytes = 8'000'000'000;  ///< of a cache whose size nobody chose

/// Finished stereo pairs on disk, found by what they follow from. One file a pair, below a folder named after
/// the first digits of its key.
///
/// Several processes may use one folder at the same time, and be killed at any time: a pair is written under
/// a temporary name and renamed when it is complete; what is read is checked, and dropped when it is not what
/// was written. All members may be called from several threads. A disk that is full or cannot be written to
/// costs the cache, never the run.
class PairCache {
 public:
  /// @param max_bytes  size above which the pairs that were not used for longest are dropped
  /// @throws InputError when the folder cannot be made
  explicit PairCache(std::string folder, uint64_t max_bytes = kCacheBytes);

  /// The images (CV_8UC1) of a key; false when there are none, or they were damaged.
  bool find(const ContentKey& key, cv::Size size, cv::Mat& left, cv::Mat& right);
  void store(const ContentKey& key, const cv::Mat& left, const cv::Mat& right);

  /// Drops what has not been used for longest until the cache is well within its size; nothing while it is
  /// within. store() does so from time to time.
  void trim();
  /// Drops everything. @return bytes freed
  uint64_t clear();

  struct Status {
    uint64_t pairs = 0;
    uint64_t bytes = 0;
  };
  Status status() const;

  const std::string& folder() const { return folder_; }
  uint64_t max_bytes() const { return max_bytes_; }
  /// Pairs found, and written, by this object.
  int64_t found() const { return found_; }
  int64_t stored() const { return stored_; }

 private:
  std::string file_of(const ContentKey& key) const;

  const std::string folder_;
  const uint64_t max_bytes_;
  std::atomic<int64_t> found_ = 0, stored_ = 0;
  std::atomic<uint64_t> next_name_ = 0;
  std::atomic<uint64_t> bytes_since_trim_ = 0;
};

/// Where pairs are kept when nobody says: $GROUNDLOOP_CACHE, else groundloop in the user's cache folder
/// ($XDG_CACHE_HOME, ~/.cache). Empty when there is none, or GROUNDLOOP_CACHE is `off`.
std::string default_cache_folder();

}  // namespace groundloop::sim
