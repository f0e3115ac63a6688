#include "sim/world/people.h"

#include <algorithm>
#include <array>
#include <vector>

namespace groundloop::sim {
namespace {

template <size_t N>
bool one_of(const std::string& value, const std::array<const char*, N>& choices) {
  return std::find(choices.begin(), choices.end(), value) != choices.end();
}

void check_person(const MjcfElement& person, const std::string& file) {
  constexpr std::array<const char*, 3> kSections = {"compiler", "asset", "worldbody"};
  constexpr std::array<const char*, 2> kParts = {"body", "geom"};
  std::vector<Problem> problems;
  size_t bodies = 0;
  for (const MjcfElement& section : person.children) {
    if (!one_of(section.tag, kSections)) {
      problems.push_back(
          section.problem(section.tag, "only compiler, asset and worldbody in a person's file"));
    }
    if (section.tag != "worldbody") continue;
    bodies += section.children.size();
    MjcfElement::walk(section, [&](const MjcfElement& part) {
      if (!one_of(part.tag, kParts)) problems.push_back(part.problem(part.tag, "only bodies and geoms"));
      if (part.tag == "geom" && part.find("type") == nullptr) {
        problems.push_back(part.problem("no type", "a type of its own: a person's file has no defaults"));
      }
    });
    for (const MjcfElement& part : section.children) {
      if (part.tag != "body") problems.push_back(part.problem(part.tag, "one body that holds all"));
    }
  }
  if (bodies != 1) {
    problems.push_back(
        {file, person.line, "worldbody", std::to_string(bodies) + " bodies", "one body that holds all"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

MjcfElement read_person(const std::string& file, const std::string& name) {
  MjcfElement person = read_mjcf(file);
  check_person(person, file);
  std::erase_if(person.children, [](const MjcfElement& section) { return section.tag == "compiler"; });
  constexpr std::array<const char*, 4> kNames = {"name", "material", "texture", "mesh"};
  MjcfElement::walk(person, [&](MjcfElement& element) {
    for (const char* key : kNames) {
      if (const std::string* own = element.find(key)) element.set(key, name + "/" + *own);
    }
    if (element.tag != "geom") return;
    element.set("contype", "0");
    element.set("conaffinity", "0");
  });
  for (MjcfElement& section : person.children) {
    if (section.tag == "worldbody") section.children.front().set("name", name);
  }
  return person;
}

}  // namespace groundloop::sim
