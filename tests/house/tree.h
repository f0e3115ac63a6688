#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace groundloop {

/// Files of the project, relative to its root, sorted: everything but what .gitignore names and .git itself.
std::vector<std::filesystem::path> tree_files();

/// The whole text of a file given relative to the root. Fails the test when it cannot be read.
std::string tree_text(const std::filesystem::path& file);

/// Files below a folder with one of these extensions.
std::vector<std::filesystem::path> tree_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& extensions);

}  // namespace groundloop
