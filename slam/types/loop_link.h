#pragma once

#include <cstdint>

#include "slam/types/pose.h"

namespace groundloop::slam {

/// What made a link between two places of the path.
enum class LinkKind {
  kLandmarks,  ///< stored visual landmarks, found again in the images
  kMap         ///< the local occupancy map, matched to the global one
};

/// Two frames that were found to see the same place.
struct LoopLink {
  LinkKind kind = LinkKind::kLandmarks;
  int64_t from_index = 0;             ///< frame of the stored key frame
  int64_t to_index = 0;               ///< frame that came back, > from_index
  Pose T_from_to = Pose::Identity();  ///< measured pose of the later left camera in the earlier
  Matrix6d covariance =
      Matrix6d::Zero();    ///< of T_from_to, right perturbation (translation, rotation) in `to`
  int inliers = 0;         ///< landmarks or cells that agree
  double residual_px = 0;  ///< rms misfit of the landmarks in the image; 0 for kMap
};

}  // namespace groundloop::slam
