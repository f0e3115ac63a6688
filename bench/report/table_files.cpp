#include "bench/report/table_files.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "slam/types/config.h"

namespace groundloop::bench {
namespace {

std::ifstream open_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(Problem{file, 0, "", "", "a readable file"});
  return in;
}

/// Next line without its line end; false at the end of the file.
bool next_line(std::istream& in, std::string& line) {
  if (!std::getline(in, line)) return false;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  size_t begin = 0;
  while (true) {
    const size_t end = line.find(',', begin);
    cells.push_back(line.substr(begin, end - begin));
    if (end == std::string::npos) return cells;
    begin = end + 1;
  }
}

/// Where a cell stands, for messages.
struct Place {
  const std::string& file;
  int line;
};

template <class T>
T parse(const std::string& text, const Place& place, const std::string& key, const char* wanted) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end)
    throw InputError(Problem{place.file, place.line, key, text, wanted});
  return value;
}

double parse_double(const std::string& text, const Place& place, const std::string& key) {
  return parse<double>(text, place, key, "a number");
}

int64_t parse_int(const std::string& text, const Place& place, const std::string& key) {
  return parse<int64_t>(text, place, key, "a whole number");
}

/// Pose from the texts of x y z qx qy qz qw.
slam::Pose parse_pose(const std::vector<std::string>& cells, size_t first, const Place& place) {
  constexpr std::array<const char*, 7> kNames = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::array<double, 7> v{};
  for (size_t i = 0; i < v.size(); ++i) v[i] = parse_double(cells[first + i], place, kNames[i]);
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!(std::abs(q.norm() - 1) < 1e-3)) {
    throw InputError(Problem{place.file, place.line, "qx qy qz qw", "", "a unit quaternion"});
  }
  slam::Pose T = slam::Pose::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  return T;
}

}  // namespace

FrameTable read_frame_table(const std::string& file) {
  static const std::set<std::string> kTextColumns = {"status", "state_hash", "message", "faults"};
  std::ifstream in = open_file(file);
  FrameTable table;
  std::string line;
  if (!next_line(in, line)) throw InputError(Problem{file, 1, "", "", "a header row"});
  const auto names = cells_of(line);
  for (const std::string& name : names) {
    if (!kTextColumns.contains(name)) table.columns[name];
  }
  for (int number = 2; next_line(in, line); ++number) {
    if (line.empty()) continue;
    const Place place{file, number};
    const auto cells = cells_of(line);
    if (cells.size() != names.size()) {
      throw InputError(Problem{file, number, "", std::to_string(cells.size()) + " cells",
                               std::to_string(names.size()) + " cells, as in the header row"});
    }
    for (size_t i = 0; i < cells.size(); ++i) {
      if (names[i] == "status") table.status.push_back(cells[i]);
      if (kTextColumns.contains(names[i])) continue;
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      table.columns[names[i]].push_back(cells[i].empty() ? kNone : parse_double(cells[i], place, names[i]));
    }
    ++table.rows;
  }
  return table;
}

std::vector<KeyFrameRow> read_key_frames(const std::string& file) {
  std::ifstream in = open_file(file);
  std::vector<KeyFrameRow> rows;
  std::string line;
  next_line(in, line);  // header
  for (int number = 2; next_line(in, line); ++number) {
    if (line.empty()) continue;
    const Place place{file, number};
    const auto cells = cells_of(line);
    if (cells.size() < 10) {
      throw InputError(
          Problem{file, number, "", line, "at least 10 cells: index,stamp_ns,segment,x,y,z,qx,qy,qz,qw"});
    }
    rows.push_back({parse_int(cells[0], place, "index"), parse_int(cells[1], place, "stamp_ns"),
                    static_cast<int>(parse_int(cells[2], place, "segment")), parse_pose(cells, 3, place)});
  }
  return rows;
}

std::vector<LinkRow> read_links(const std::string& file) {
  std::ifstream in = open_file(file);
  std::vector<LinkRow> rows;
  std::string line;
  next_line(in, line);  // header
  for (int number = 2; next_line(in, line); ++number) {
    if (line.empty()) continue;
    const Place place{file, number};
    const auto cells = cells_of(line);
    if (cells.size() != 16) {
      throw InputError(Problem{file, number, "", line, "16 cells: kind,from_index,to_index, ... ,right"});
    }
    rows.push_back(
        {parse_int(cells[1], place, "from_index"), parse_int(cells[2], place, "to_index"), cells[15] == "0"});
  }
  return rows;
}

const std::vector<double>& FrameTable::column(const std::string& name) const {
  static const std::vector<double> kNone;
  const auto found = columns.find(name);
  return found == columns.end() ? kNone : found->second;
}

}  // namespace groundloop::bench
