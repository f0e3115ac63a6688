#include "slam/source/text.h"

#include <charconv>
#include <filesystem>
#include <fstream>

#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

template <class T>
std::optional<T> whole_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // from_chars knows no plus
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> to_double(std::string_view text) { return whole_number<double>(text); }
std::optional<int64_t> to_int64(std::string_view text) { return whole_number<int64_t>(text); }

std::optional<int64_t> seconds_to_ns(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);

  // "12.345e-2" -> digits 12345, of which the last 3 + 2 are behind the point
  int64_t exponent = 0;
  if (const size_t e = text.find_first_of("eE"); e != std::string_view::npos) {
    const auto parsed = to_int64(text.substr(e + 1));
    if (!parsed || std::abs(*parsed) > 100) return std::nullopt;
    exponent = *parsed;
    text = text.substr(0, e);
  }
  std::string digits;
  bool point = false;
  for (const char c : text) {
    if (c == '.' && !point) {
      point = true;
    } else if (c >= '0' && c <= '9') {
      digits += c;
      if (point) --exponent;
    } else {
      return std::nullopt;
    }
  }
  if (digits.empty()) return std::nullopt;

  // Shift by nine places to nanoseconds, then cut or pad.
  const int64_t shift = exponent + 9;
  bool round_up = false;
  if (shift >= 0) {
    digits.append(static_cast<size_t>(shift), '0');
  } else {
    const size_t cut = static_cast<size_t>(-shift);
    if (cut > digits.size()) return 0;
    round_up = digits[digits.size() - cut] >= '5';
    digits.resize(digits.size() - cut);
    if (digits.empty()) digits = "0";
  }
  const auto value = to_int64(digits);
  if (!value || *value == INT64_MAX) return std::nullopt;
  const int64_t magnitude = *value + (round_up ? 1 : 0);
  return negative ? -magnitude : magnitude;
}

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return parts;
}

std::vector<TextLine> read_lines(const std::string& file, const std::string& wanted) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(Problem{file, 0, "", "no such file", wanted});
  }
  std::ifstream in(file);
  if (!in) throw InputError(Problem{file, 0, "", "cannot be opened", wanted});
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos || text[first] == '#') continue;
    lines.push_back({number, text});
  }
  return lines;
}

}  // namespace groundloop::slam
