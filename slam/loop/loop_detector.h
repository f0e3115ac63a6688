#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slam/loop/descriptors.h"
#include "slam/loop/loop_options.h"
#include "slam/loop/loop_verifier.h"
#include "slam/loop/place_index.h"
#include "slam/loop/stored_view.h"
#include "slam/stereo/right_lag.h"
#include "slam/types/loop_link.h"

namespace groundloop::slam {

/// A key frame as it is handed to the loop detector. Images must not change afterwards.
struct LoopKeyFrame {
  int64_t index = 0;  ///< of the frame, increasing
  /// Frame since which the tracker has not lost sight of what it sees now; views younger than this are no
  /// news. The largest: whatever was seen before is.
  int64_t in_sight_since = std::numeric_limits<int64_t>::max();
  cv::Mat left, right;     ///< rectified, CV_8UC1
  RightLag right_lag;      ///< of `right`
  cv::Mat half_disparity;  ///< DenseDisparity::half_resolution() of the pair
  std::vector<Landmark> landmarks;
};

/// What trajectory and odometry know now of frame `to` in frame `from`; none when nothing connects them.
using RelativePose = std::function<std::optional<PosePrediction>(int64_t from_index, int64_t to_index)>;

/// What became of one key frame.
struct LoopAnswer {
  std::optional<LoopLink> link;
  std::string message;  ///< why there is no link
  bool stored = false;  ///< whether the key frame itself is kept now
};

/// Recognises places: keeps views of key frames, and tells for each new key frame which stored view shows the
/// same place and where in it the camera stands. All its state is its own; one thread uses it.
class LoopDetector {
 public:
  LoopDetector(const StereoRig& rig, const LoopOptions& options, const KltOptions& klt,
               const StereoOptions& stereo, const RegistrationOptions& registration, uint64_t seed);

  /// Looks for the key frame's place among the stored views, then stores it unless a stored view covers it.
  LoopAnswer process(const LoopKeyFrame& key_frame, const RelativePose& relative_pose);

  const std::vector<StoredView>& views() const { return views_; }
  size_t bytes() const;

 private:
  /// A stored view worth a closer look.
  struct Candidate {
    int view;
    double score;
    std::optional<PosePrediction> prediction;
  };
  /// The best link so far of one key frame.
  struct Accepted {
    LoopLink link;
    double inlier_ratio;
    bool predicted;
  };
  /// A link that nothing predicted and that waits for another one to agree with it.
  struct Pending {
    LoopLink link;
    int agreeing;
  };

  void recognise(const RelativePose& relative_pose, LoopAnswer& answer, bool& covered);
  void choose_candidates(const RelativePose& relative_pose);
  void add_likeness();
  void keep_the_best(const RelativePose& relative_pose);
  double predicted_overlap(const StoredView& stored, const Pose& T_from_to) const;
  bool agree(const LoopLink& a, const LoopLink& b, const RelativePose& relative_pose) const;
  bool confirmed(const LoopLink& link, const RelativePose& relative_pose);

  StereoRig rig_;
  LoopOptions options_;
  int pyramid_levels_;
  uint64_t seed_;
  Describer describer_;
  PlaceIndex index_;
  LoopVerifier verifier_;
  std::vector<StoredView> views_;
  CurrentView current_;
  int64_t in_sight_since_ = 0;  ///< of the current key frame
  std::vector<PlaceCandidate> alike_;
  std::vector<Candidate> candidates_;
  std::optional<Pending> pending_;
};

}  // namespace groundloop::slam
