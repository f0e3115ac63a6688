#include "slam/mapping/map_io.h"

#include <fmt/format.h>
#include <octomap/OcTree.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "slam/mapping/atomic_file.h"
#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

constexpr int kFreeGrey = 254;
constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.35;

uint8_t grey_of(float value) {
  return static_cast<uint8_t>(std::lround(kFreeGrey * (1.0 - std::clamp(value, 0.0F, 1.0F))));
}

void write_pgm(std::ostream& out, const OccupancyMap& map) {
  const GridGeometry& geometry = map.geometry;
  out << fmt::format("P5\n{} {}\n255\n", geometry.cols, geometry.rows);
  std::vector<char> line(geometry.cols);
  for (int row = geometry.rows - 1; row >= 0; --row) {
    for (int col = 0; col < geometry.cols; ++col) line[col] = static_cast<char>(grey_of(map.at(col, row)));
    out.write(line.data(), geometry.cols);
  }
}

struct Pgm {
  int cols = 0, rows = 0;
  std::vector<uint8_t> grey;  ///< highest y first
};

/// The next number of a PGM header; comments run from # to the end of the line.
int next_number(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  int number = -1;
  in >> number;
  return number;
}

Pgm read_pgm(const std::string& file) {
  const auto fail = [&](const std::string& what) {
    throw InputError(Problem{file, 0, "", what, "an 8-bit PGM image (P5)"});
  };
  std::ifstream in(file, std::ios::binary);
  if (!in) fail("no such file");
  std::string magic;
  in >> magic;
  Pgm pgm;
  pgm.cols = next_number(in), pgm.rows = next_number(in);
  const int max_grey = next_number(in);
  constexpr int kLargestSide = 1 << 16;
  if (magic != "P5" || pgm.cols < 1 || pgm.rows < 1 || pgm.cols > kLargestSide || pgm.rows > kLargestSide ||
      max_grey != 255) {
    fail("another kind of file");
  }
  in.get();  // the one blank behind the header
  pgm.grey.resize(static_cast<size_t>(pgm.cols) * pgm.rows);
  in.read(reinterpret_cast<char*>(pgm.grey.data()), static_cast<std::streamsize>(pgm.grey.size()));
  if (in.gcount() != static_cast<std::streamsize>(pgm.grey.size())) fail("ends too early");
  return pgm;
}

/// The keys of a map_server YAML.
struct MapFile {
  std::string image, mode = "trinary";
  double resolution = 0, occupied_thresh = kOccupiedThreshold, free_thresh = kFreeThreshold;
  std::vector<double> origin;  ///< x [m], y [m], yaw [rad] of the lower left corner
  int negate = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("image", image, {.required = true});
    a("mode", mode);
    a("resolution", resolution, {.min = 1e-6, .required = true});
    a("origin", origin, {.required = true});
    a("negate", negate, {.min = 0, .max = 1});
    a("occupied_thresh", occupied_thresh, {.min = 0, .max = 1});
    a("free_thresh", free_thresh, {.min = 0, .max = 1});
  }
  void check(ConfigReader& reader) const {
    if (reader.has("origin") && (origin.size() != 3 || origin[2] != 0)) {
      reader.problem("origin", "x, y and a yaw of 0");
    }
  }
  bool graded() const { return occupied_thresh == kOccupiedThreshold && free_thresh == kFreeThreshold; }
  float value_of(uint8_t grey) const {
    if (negate != 0) grey = static_cast<uint8_t>(255 - grey);
    if (graded()) {
      // 127 is the rounded grey of exactly 1/2, and stays that.
      return grey == grey_of(OccupancyMap::kUnknown)
                 ? OccupancyMap::kUnknown
                 : 1.0F - static_cast<float>(std::min<int>(grey, kFreeGrey)) / kFreeGrey;
    }
    const double p = (255 - grey) / 255.0;
    return p > occupied_thresh ? 1.0F : p < free_thresh ? 0.0F : OccupancyMap::kUnknown;
  }
};

}  // namespace

void write_map(const std::string& stem, const OccupancyMap& map) {
  if (map.geometry.cells() == 0) {
    OccupancyMap one = map;
    one.geometry.cols = one.geometry.rows = 1;
    one.value = {OccupancyMap::kUnknown};
    return write_map(stem, one);
  }
  const std::string image = std::filesystem::path(stem + ".pgm").filename().string();
  write_file_atomically(stem + ".pgm", [&](std::ostream& out) { write_pgm(out, map); });
  write_file_atomically(stem + ".yaml", [&](std::ostream& out) {
    out << fmt::format(
        "image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\noccupied_thresh: {}\n"
        "free_thresh: {}\n",
        image, map.geometry.cell_m, map.geometry.x_min_m, map.geometry.y_min_m, kOccupiedThreshold,
        kFreeThreshold);
  });
}

OccupancyMap read_map(const std::string& yaml_file) {
  MapFile header;
  std::vector<Problem> problems;
  read_config(load_yaml_file(yaml_file), yaml_file, header, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  const Pgm pgm = read_pgm((std::filesystem::path(yaml_file).parent_path() / header.image).string());
  OccupancyMap map;
  map.geometry = {header.resolution, header.origin[0], header.origin[1], pgm.cols, pgm.rows};
  map.value.resize(map.geometry.cells());
  for (int row = 0; row < pgm.rows; ++row) {
    const uint8_t* line = &pgm.grey[static_cast<size_t>(pgm.rows - 1 - row) * pgm.cols];
    for (int col = 0; col < pgm.cols; ++col)
      map.value[map.geometry.index(col, row)] = header.value_of(line[col]);
  }
  return map;
}

void write_octomap(const std::string& file, const std::vector<OccupancyMap>& layers,
                   const std::vector<double>& layer_heights_m) {
  const double voxel_m = layers.empty() ? 0.05 : layers.front().geometry.cell_m;
  octomap::OcTree tree(voxel_m);
  for (size_t layer = 0; layer < layers.size(); ++layer) {
    const GridGeometry& geometry = layers[layer].geometry;
    // Voxels whose centre lies in the layer.
    const int begin = static_cast<int>(std::ceil(layer_heights_m.at(layer) / voxel_m - 0.5 - 1e-9));
    const int end = static_cast<int>(std::ceil(layer_heights_m.at(layer + 1) / voxel_m - 0.5 - 1e-9));
    for (int row = 0; row < geometry.rows; ++row) {
      for (int col = 0; col < geometry.cols; ++col) {
        const float value = layers[layer].at(col, row);
        const bool occupied = value > OccupancyMap::kOccupiedAbove;
        if (!occupied && !(value < OccupancyMap::kFreeBelow)) continue;
        const float log_odds = occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog();
        const Eigen::Vector2d centre_m = geometry.centre_m(col, row);
        for (int level = begin; level < end; ++level) {
          tree.setNodeValue(centre_m.x(), centre_m.y(), (level + 0.5) * voxel_m, log_odds, true);
        }
      }
    }
  }
  tree.updateInnerOccupancy();
  // OcTree::writeBinary would say so on the terminal; its header is this.
  write_file_atomically(file, [&](std::ostream& out) {
    out << "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as "
           "it is!)\n"
        << "#\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
        << "\ndata\n";
    tree.writeBinaryData(out);
  });
}

}  // namespace groundloop::slam
