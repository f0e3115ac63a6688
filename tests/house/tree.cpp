#include "tests/house/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace groundloop {
namespace {

const fs::path kRoot = GROUNDLOOP_ROOT;

bool is_ignored(const fs::path& relative) {
  const std::string name = relative.generic_string();
  return name == ".git" || name == "build" || name == "runs" || name == "models/generated" ||
         name == "compile_commands.json" || name.ends_with(".tmp");
}

}  // namespace

std::vector<fs::path> tree_files() {
  std::vector<fs::path> files;
  for (auto it = fs::recursive_directory_iterator(kRoot); it != fs::recursive_directory_iterator(); ++it) {
    const fs::path relative = fs::relative(it->path(), kRoot);
    if (is_ignored(relative)) {
      it.disable_recursion_pending();
    } else if (it->is_regular_file()) {
      files.push_back(relative);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string tree_text(const fs::path& file) {
  std::ifstream in(kRoot / file, std::ios::binary);
  EXPECT_TRUE(in) << file << " cannot be read";
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> tree_files(const fs::path& folder, const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const fs::path& file : tree_files()) {
    const bool wanted =
        std::find(extensions.begin(), extensions.end(), file.extension().string()) != extensions.end();
    if (wanted && file.generic_string().starts_with(folder.generic_string() + "/")) files.push_back(file);
  }
  return files;
}

}  // namespace groundloop
