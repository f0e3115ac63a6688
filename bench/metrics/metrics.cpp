#include "bench/metrics/metrics.h"

#include <nlohmann/json.hpp>

namespace groundloop::bench {

std::string to_json(const Metrics& metrics) { return nlohmann::json(metrics).dump(2) + "\n"; }

}  // namespace groundloop::bench
