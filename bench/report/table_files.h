#pragma once

#include <string>
#include <vector>

#include "bench/report/run_folder.h"

namespace groundloop::bench {

// Readers of the run folder's tables. All throw InputError with file, line, column, value and what was
// wanted.

FrameTable read_frame_table(const std::string& file);
std::vector<KeyFrameRow> read_key_frames(const std::string& file);
std::vector<LinkRow> read_links(const std::string& file);

}  // namespace groundloop::bench
