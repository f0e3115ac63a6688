#include "slam/mapping/flog_options.h"

#include <algorithm>

namespace groundloop::slam {

void FlogOptions::check(ConfigReader& reader) const {
  const bool rising = std::is_sorted(layer_heights_m.begin(), layer_heights_m.end(), std::less_equal<>());
  if (layer_heights_m.size() < 2 || !rising) reader.problem("layer_heights_m", "two or more rising heights");
}

}  // namespace groundloop::slam
