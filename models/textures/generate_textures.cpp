// Draws the textures of models/worlds into a folder: generate_textures FOLDER. The same bytes on every run.

#include <fmt/format.h>

#include <unistd.h>

#include <exception>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "models/textures/textures.h"

namespace fs = std::filesystem;

int main(int argc, char** argv) try {
  if (argc != 2) {
    fmt::print(stderr, "usage: generate_textures FOLDER\n");
    return 2;
  }
  const fs::path folder = argv[1];
  fs::create_directories(folder);
  // Several builds may share the folder: each file appears complete or not at all.
  const fs::path scratch = fs::path(folder) / fmt::format("scratch-{}", static_cast<long>(getpid()));
  fs::create_directories(scratch);
  for (const groundloop::textures::Texture& texture : groundloop::textures::all_textures()) {
    const fs::path file = fmt::format("{}.png", texture.name);
    if (!cv::imwrite((scratch / file).string(), texture.draw(texture.key))) {
      throw std::runtime_error("cannot write " + (scratch / file).string());
    }
    fs::rename(scratch / file, folder / file);
  }
  fs::remove_all(scratch);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "generate_textures: {}\n", error.what());
  return 3;
}
