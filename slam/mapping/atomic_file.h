#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace groundloop::slam {

/// Writes a file under a temporary name beside it and renames it when complete, so that no half file bears
/// the name.
/// @throws InputError naming the file when it cannot be written
void write_file_atomically(const std::string& file, const std::function<void(std::ostream&)>& write);

}  // namespace groundloop::slam
