#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace groundloop::slam {

/// Decimal seconds ("1.5", "-98.449999872", "1.000000e-01") -> nanoseconds, exactly: digits are moved, not
/// rounded through a double. Digits below one nanosecond are rounded half away from zero.
/// @return none when the text is not a number or does not fit int64
std::optional<int64_t> seconds_to_ns(std::string_view text);

/// The whole text as a number; none when anything else follows it.
std::optional<double> to_double(std::string_view text);
std::optional<int64_t> to_int64(std::string_view text);

/// Parts between any of the separators, without empty ones.
std::vector<std::string_view> split(std::string_view text, std::string_view separators);

struct TextLine {
  int number = 0;  ///< from 1
  std::string text;
};
/// Lines of a file that are neither blank nor comments (#); line ends of DOS are removed.
/// @throws InputError naming the file when it cannot be read
std::vector<TextLine> read_lines(const std::string& file, const std::string& wanted);

}  // namespace groundloop::slam
