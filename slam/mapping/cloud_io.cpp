#include "slam/mapping/cloud_io.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <fstream>

#include "slam/mapping/atomic_file.h"
#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as it lies in memory");

constexpr std::array<const char*, 7> kProperties = {
    "property float x",     "property float y",    "property float z",    "property uchar red",
    "property uchar green", "property uchar blue", "property float sigma"};
constexpr size_t kPointBytes = 19;

void pack(const PlyPoint& point, char* bytes) {
  std::memcpy(bytes, point.p_map.data(), 12);
  std::memset(bytes + 12, point.grey, 3);
  std::memcpy(bytes + 15, &point.sigma_m, 4);
}

PlyPoint unpack(const char* bytes) {
  PlyPoint point;
  std::memcpy(point.p_map.data(), bytes, 12);
  std::memcpy(&point.grey, bytes + 12, 1);
  std::memcpy(&point.sigma_m, bytes + 15, 4);
  return point;
}

}  // namespace

void write_ply(const std::string& file, const std::vector<PlyPoint>& points) {
  write_file_atomically(file, [&](std::ostream& out) {
    out << "ply\nformat binary_little_endian 1.0\n" << fmt::format("element vertex {}\n", points.size());
    for (const char* property : kProperties) out << property << "\n";
    out << "end_header\n";
    std::array<char, kPointBytes> bytes{};
    for (const PlyPoint& point : points) {
      pack(point, bytes.data());
      out.write(bytes.data(), bytes.size());
    }
  });
}

std::vector<PlyPoint> read_ply(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(Problem{file, 0, "", "no such file", "a PLY cloud that can be read"});
  int line_number = 0;
  std::string line;
  const auto expect = [&](const std::string& wanted) {
    ++line_number;
    if (!std::getline(in, line) || line != wanted)
      throw InputError(Problem{file, line_number, "", line, wanted});
  };
  expect("ply");
  expect("format binary_little_endian 1.0");
  ++line_number;
  size_t count = 0;
  if (!std::getline(in, line) || std::sscanf(line.c_str(), "element vertex %zu", &count) != 1) {
    throw InputError(Problem{file, line_number, "", line, "element vertex and their number"});
  }
  for (const char* property : kProperties) expect(property);
  expect("end_header");

  std::vector<PlyPoint> points;
  std::array<char, kPointBytes> bytes{};
  while (points.size() < count && in.read(bytes.data(), bytes.size())) points.push_back(unpack(bytes.data()));
  if (points.size() != count) {
    throw InputError(
        Problem{file, 0, "", fmt::format("{} points", points.size()), fmt::format("{} points", count)});
  }
  return points;
}

}  // namespace groundloop::slam
