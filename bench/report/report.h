#pragma once

#include <string>

namespace groundloop::bench {

/// Draws the figures of a run and writes its report.html: self-contained, no network, below 5 MB. Reads
/// nothing but the run folder, so an old run can be reported again. Also writes figures/top_view.png,
/// figures/map.png and figures/map_difference.png where their inputs exist; a part whose inputs are missing
/// says so in the report. Every file is written to a temporary name and renamed.
///
/// @return path of the report
/// @throws InputError when run.json is missing or a file of the folder is malformed, or cannot be written
std::string write_report(const std::string& run_dir);

}  // namespace groundloop::bench
