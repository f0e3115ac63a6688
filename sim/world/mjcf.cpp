#include "sim/world/mjcf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace groundloop::sim {
namespace fs = std::filesystem;
namespace {

/// Expands includes while it copies tinyxml2's tree into ours.
class Reader {
 public:
  explicit Reader(const std::string& main_file) : directory_(fs::absolute(main_file).parent_path()) {}

  MjcfElement read(const std::string& file) {
    tinyxml2::XMLDocument document;
    return read(open(file, document), file);
  }

  MjcfElement read_text(const std::string& text, const std::string& name) {
    tinyxml2::XMLDocument document;
    document.Parse(text.data(), text.size());
    return read(checked_root(document, name), name);
  }

 private:
  MjcfElement read(const tinyxml2::XMLElement* root, const std::string& file) {
    if (std::string_view(root->Name()) != "mujoco") {
      throw InputError(
          Problem{file, root->GetLineNum(), fmt::format("<{}>", root->Name()), "", "an MJCF file, <mujoco>"});
    }
    MjcfElement element = header(*root, file);
    read_children(*root, file, element);
    return element;
  }

  const tinyxml2::XMLElement* open(const std::string& file, tinyxml2::XMLDocument& document) {
    if (!fs::is_regular_file(file)) throw InputError(Problem{file, 0, "", "no such file", "an MJCF file"});
    files_.insert(fs::weakly_canonical(file).string());
    document.LoadFile(file.c_str());
    return checked_root(document, file);
  }

  static const tinyxml2::XMLElement* checked_root(const tinyxml2::XMLDocument& document, const std::string& file) {
    if (document.Error()) {
      throw InputError(Problem{file, document.ErrorLineNum(), "",
                               tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()), "well-formed XML"});
    }
    return document.RootElement();
  }

  static MjcfElement header(const tinyxml2::XMLElement& from, const std::string& file) {
    MjcfElement element{from.Name(), {}, {}, file, from.GetLineNum()};
    for (const auto* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
      element.attributes.emplace_back(a->Name(), a->Value());
    }
    return element;
  }

  void read_children(const tinyxml2::XMLElement& from, const std::string& file, MjcfElement& to) {
    for (const auto* child = from.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      MjcfElement element = header(*child, file);
      if (element.tag == "include") {
        include(element, to);
      } else {
        read_children(*child, file, element);
        to.children.push_back(std::move(element));
      }
    }
  }

  void include(const MjcfElement& element, MjcfElement& to) {
    const std::string path = (directory_ / element.get("file")).lexically_normal().string();
    if (!fs::is_regular_file(path)) {
      throw InputError(element.problem(path, "an existing file (includes are relative to the main file)"));
    }
    if (files_.contains(fs::weakly_canonical(path).string())) {
      throw InputError(element.problem(path, "every file to be included once only"));
    }
    tinyxml2::XMLDocument document;
    read_children(*open(path, document), path, to);
  }

  fs::path directory_;
  std::set<std::string> files_;
};

/// The settings of all <compiler> sections, as MuJoCo reads them: a later one overrides an earlier one.
std::string compiler_setting(const MjcfElement& root, std::string_view key) {
  std::string value;
  for (const MjcfElement& section : root.children) {
    if (section.tag == "compiler") value = section.get(key, value);
  }
  return value;
}

void make_absolute(MjcfElement& element, std::string_view key, const fs::path& directory, bool strip,
                   std::vector<Problem>& problems) {
  const std::string* value = element.find(key);
  if (value == nullptr || value->empty()) return;
  const fs::path given = strip ? fs::path(*value).filename() : fs::path(*value);
  const fs::path path = (directory / given).lexically_normal();
  if (!fs::is_regular_file(path)) {
    std::string wanted = "an existing file";
    if (std::find(path.begin(), path.end(), "generated") != path.end()) {
      wanted += " (files below models/generated are made by the build: cmake --build --preset release)";
    }
    problems.push_back(element.problem(path.string(), wanted));
  }
  element.set(key, path.string());
}

void resolve_assets(MjcfElement& root, const fs::path& main_directory) {
  const std::string assets = compiler_setting(root, "assetdir");
  const std::string meshes = compiler_setting(root, "meshdir");
  const std::string textures = compiler_setting(root, "texturedir");
  const fs::path mesh_directory = main_directory / (meshes.empty() ? assets : meshes);
  const fs::path texture_directory = main_directory / (textures.empty() ? assets : textures);
  const bool strip = compiler_setting(root, "strippath") == "true";
  for (MjcfElement& section : root.children) {
    if (section.tag != "compiler") continue;
    for (const char* key : {"assetdir", "meshdir", "texturedir", "strippath"}) section.erase(key);
  }

  std::vector<Problem> problems;
  MjcfElement::walk(root, [&](MjcfElement& element) {
    if (element.tag == "mesh" || element.tag == "hfield" || element.tag == "skin") {
      make_absolute(element, "file", mesh_directory, strip, problems);
    } else if (element.tag == "texture") {
      for (const char* key :
           {"file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"}) {
        make_absolute(element, key, texture_directory, strip, problems);
      }
    }
  });
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::string escaped(const std::string& value) {
  std::string text;
  for (const char c : value) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '"':
        text += "&quot;";
        break;
      case '\n':
        text += ' ';
        break;
      default:
        text += c;
    }
  }
  return text;
}

void write(const MjcfElement& element, MjcfText& out) {
  out.text += '<' + element.tag;
  for (const auto& [key, value] : element.attributes)
    out.text += fmt::format(" {}=\"{}\"", key, escaped(value));
  out.text += element.children.empty() ? "/>\n" : ">\n";
  out.element_of_line.push_back(&element);
  if (element.children.empty()) return;
  for (const MjcfElement& child : element.children) write(child, out);
  out.text += "</" + element.tag + ">\n";
  out.element_of_line.push_back(&element);
}

}  // namespace

const std::string* MjcfElement::find(std::string_view key) const {
  for (const auto& [name, value] : attributes) {
    if (name == key) return &value;
  }
  return nullptr;
}

std::string MjcfElement::get(std::string_view key, const std::string& otherwise) const {
  const std::string* value = find(key);
  return value == nullptr ? otherwise : *value;
}

void MjcfElement::set(std::string_view key, const std::string& value) {
  for (auto& [name, old] : attributes) {
    if (name == key) {
      old = value;
      return;
    }
  }
  attributes.emplace_back(key, value);
}

void MjcfElement::erase(std::string_view key) {
  std::erase_if(attributes, [&](const auto& attribute) { return attribute.first == key; });
}

std::string MjcfElement::title() const {
  const std::string* name = find("name");
  return name == nullptr ? tag : fmt::format("{} '{}'", tag, *name);
}

Problem MjcfElement::problem(const std::string& value, const std::string& wanted) const {
  return Problem{file, line, title(), value, wanted};
}

MjcfElement read_mjcf(const std::string& file) {
  MjcfElement root = Reader(file).read(file);
  resolve_assets(root, fs::absolute(file).parent_path());
  return root;
}

MjcfElement read_mjcf_text(const std::string& text, const std::string& name) {
  MjcfElement root = Reader(name).read_text(text, name);
  resolve_assets(root, fs::absolute(name).parent_path());
  return root;
}

MjcfText write_mjcf(const MjcfElement& root) {
  MjcfText out;
  write(root, out);
  return out;
}

}  // namespace groundloop::sim
