#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// One element of an MJCF file, with the place where the user wrote it.
struct MjcfElement {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<MjcfElement> children;
  std::string file;
  int line = 0;

  /// Value of an attribute; nullptr when it is not given.
  const std::string* find(std::string_view key) const;
  /// Value of an attribute, or `otherwise`.
  std::string get(std::string_view key, const std::string& otherwise = "") const;
  void set(std::string_view key, const std::string& value);
  void erase(std::string_view key);

  /// "geom 'table'", for messages.
  std::string title() const;
  Problem problem(const std::string& value, const std::string& wanted) const;

  /// Calls visit(element) for every element below this one, parents first.
  template <class Element, class Visit>
  static void walk(Element& root, const Visit& visit) {
    for (auto& child : root.children) {
      visit(child);
      walk(child, visit);
    }
  }
};

/// Reads an MJCF file into its `<mujoco>` element: includes are expanded as MuJoCo does (relative to the main
/// file, each file once), and paths of mesh, texture, height-field and skin files become absolute (compiler
/// meshdir, texturedir, assetdir and strippath are applied and removed).
/// @throws InputError naming file, line and element: unreadable XML, a missing include, all missing assets
MjcfElement read_mjcf(const std::string& file);

/// The same of a text in memory. @param name  in place of the file, for messages and relative paths
MjcfElement read_mjcf_text(const std::string& text, const std::string& name);

/// MJCF text with one element a line, so that a line number of MuJoCo's leads back to the user's file.
struct MjcfText {
  std::string text;
  std::vector<const MjcfElement*> element_of_line;  ///< index 0 is line 1; points into the written tree
};
MjcfText write_mjcf(const MjcfElement& root);

}  // namespace groundloop::sim
