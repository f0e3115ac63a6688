#include "sim/scenario/camera_plan.h"

namespace groundloop::sim {

void PathPiece::check(ConfigReader& reader) const {
  const int members = straight_m.has_value() + sideways_m.has_value() + arc.has_value();
  if (members != 1) reader.problem("", "exactly one of: straight_m, sideways_m, arc");
}

void CameraPath::check(ConfigReader& reader) const {
  if (drive.has_value() == raster.has_value()) reader.problem("", "exactly one of: drive, raster");
  if (drive && drive->pieces.empty()) reader.problem("drive", "at least one piece");
}

}  // namespace groundloop::sim
