#include "sim/world/compose.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

namespace groundloop::sim {
namespace {

bool one_of(const std::string& value, std::initializer_list<const char*> choices) {
  return std::find(choices.begin(), choices.end(), value) != choices.end();
}

/// All sections of one tag as one: later attributes override, children follow in order.
MjcfElement merged_section(const MjcfElement& root, const std::string& tag) {
  MjcfElement section{tag, {}, {}, root.file, root.line};
  for (const MjcfElement& part : root.children) {
    if (part.tag != tag) continue;
    section.file = part.file;
    section.line = part.line;
    for (const auto& [key, value] : part.attributes) section.set(key, value);
    section.children.insert(section.children.end(), part.children.begin(), part.children.end());
  }
  return section;
}

bool has_joints(const MjcfElement& root) {
  bool found = false;
  MjcfElement::walk(root, [&](const MjcfElement& element) {
    found = found || one_of(element.tag, {"joint", "freejoint", "composite"});
  });
  return found;
}

// ---- default classes
// -------------------------------------------------------------------------------------------

/// Adds `from` to a default class; an element that is there already gets the new attributes on top.
void add_default(MjcfElement& to, const MjcfElement& from) {
  const auto same = std::find_if(to.children.begin(), to.children.end(), [&](const MjcfElement& child) {
    return child.tag == from.tag && from.tag != "default";
  });
  if (same == to.children.end()) {
    to.children.push_back(from);
  } else {
    for (const auto& [key, value] : from.attributes) same->set(key, value);
  }
}

/// Makes the file's default classes its own: the top class becomes `scope`, all others `scope/name`.
void scope_defaults(MjcfElement& root, const std::string& scope) {
  MjcfElement top{"default", {{"class", scope}}, {}, root.file, root.line};
  std::set<std::string> top_names = {"main", ""};
  for (const MjcfElement& section : root.children) {
    if (section.tag != "default") continue;
    top_names.insert(section.get("class"));
    for (const MjcfElement& child : section.children) add_default(top, child);
  }
  if (top.children.empty()) return;
  std::erase_if(root.children, [](const MjcfElement& section) { return section.tag == "default"; });

  const auto scoped = [&](const std::string& name) {
    return top_names.contains(name) ? scope : scope + "/" + name;
  };
  const auto rename = [&](MjcfElement& element) {
    for (const char* key : {"class", "childclass"}) {
      if (const std::string* name = element.find(key)) element.set(key, scoped(*name));
    }
  };
  MjcfElement::walk(top, rename);
  MjcfElement::walk(root, rename);

  // Elements without a class meant the file's own top class.
  const auto adopt = [&](MjcfElement& element, const char* key) {
    if (element.find("class") == nullptr && element.find(key) == nullptr) element.set(key, scope);
  };
  for (MjcfElement& section : root.children) {
    for (MjcfElement& element : section.children) {
      if (section.tag == "worldbody") {
        if (element.tag == "body") adopt(element, "childclass");
        if (one_of(element.tag, {"geom", "site", "camera", "light"})) adopt(element, "class");
      } else if (one_of(section.tag, {"equality", "tendon", "actuator"}) ||
                 one_of(element.tag, {"mesh", "material", "pair"})) {
        adopt(element, "class");
      }
    }
  }
  MjcfElement main{"default", {{"class", "main"}}, {std::move(top)}, root.file, root.line};
  root.children.push_back(std::move(main));
}

// ---- units
// ---------------------------------------------------------------------------------------------------

struct Units {
  bool degrees = true;
  std::string euler = "xyz";
};

Units units_of(const MjcfElement& compiler) {
  return {compiler.get("angle", "degree") == "degree", compiler.get("eulerseq", "xyz")};
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

std::string text_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", value);
  return text;
}

/// Orientation of three Euler angles [rad]; lower-case axes turn with the body, upper-case ones stand still.
Eigen::Quaterniond from_euler(const std::vector<double>& angles_rad, const std::string& sequence) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (size_t i = 0; i < 3; ++i) {
    const int axis = std::tolower(sequence[i]) - 'x';
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angles_rad[i], Eigen::Vector3d::Unit(axis)));
    q = std::islower(sequence[i]) != 0 ? q * turn : turn * q;
  }
  return q;
}

/// Rewrites every angle of the tree from one file's units to the other's.
void convert_angles(MjcfElement& root, const Units& from, const Units& to, std::vector<Problem>& problems) {
  const double to_rad = from.degrees ? std::numbers::pi / 180 : 1;
  const double factor = to_rad * (to.degrees ? 180 / std::numbers::pi : 1);
  const auto convert = [&](MjcfElement& element) {
    if (const std::string* euler = element.find("euler")) {
      std::vector<double> angles = numbers(*euler);
      if (angles.size() != 3 || from.euler.size() != 3) {
        problems.push_back(element.problem(*euler, "three angles in `euler`"));
        return;
      }
      for (double& angle : angles) angle *= to_rad;
      const Eigen::Quaterniond q = from_euler(angles, from.euler);
      element.erase("euler");
      element.set("quat", text_of({q.w(), q.x(), q.y(), q.z()}));
    }
    if (const std::string* axis_angle = element.find("axisangle")) {
      std::vector<double> values = numbers(*axis_angle);
      if (!values.empty()) values.back() *= factor;
      element.set("axisangle", text_of(values));
    }
    if (element.tag == "joint" && factor != 1 && element.get("type", "hinge") != "slide") {
      for (const char* key : {"range", "ref", "springref"}) {
        const std::string* value = element.find(key);
        if (value == nullptr) continue;
        std::vector<double> values = numbers(*value);
        for (double& v : values) v *= factor;
        element.set(key, text_of(values));
      }
    }
  };
  MjcfElement::walk(root, convert);
}

/// A joint's range is an angle or a length by its type; a type that comes from a class is not followed here.
void check_joint_types(const MjcfElement& root, std::vector<Problem>& problems) {
  bool typed_class = false;
  for (const MjcfElement& section : root.children) {
    if (section.tag != "default") continue;
    MjcfElement::walk(section, [&](const MjcfElement& element) {
      typed_class = typed_class || (element.tag == "joint" && element.find("type") != nullptr);
      if (element.tag == "joint" && element.find("range") != nullptr) {
        problems.push_back(
            element.problem("range in a default class",
                            "the range in the joints themselves, or the same <compiler angle> in world "
                            "and robot"));
      }
    });
  }
  MjcfElement::walk(root, [&](const MjcfElement& element) {
    if (typed_class && element.tag == "joint" && element.find("range") != nullptr &&
        element.find("type") == nullptr) {
      problems.push_back(element.problem("joint without a type of its own",
                                         "`type`, or the same <compiler angle> in world and robot"));
    }
  });
}

// ---- sections
// ------------------------------------------------------------------------------------------------

/// The robot's compiler settings; those of the world must not differ where they matter to it.
MjcfElement compose_compiler(MjcfElement& world, const MjcfElement& robot, std::vector<Problem>& problems) {
  const MjcfElement from_world = merged_section(world, "compiler");
  MjcfElement compiler = merged_section(robot, "compiler");
  // Both would remove geoms or bodies: what is in the files is what is rendered and judged.
  for (const char* key : {"discardvisual", "fusestatic"}) compiler.erase(key);

  const Units world_units = units_of(from_world), robot_units = units_of(compiler);
  if (world_units.degrees != robot_units.degrees || world_units.euler != robot_units.euler) {
    if (world_units.degrees != robot_units.degrees) check_joint_types(world, problems);
    convert_angles(world, world_units, robot_units, problems);
  }
  const bool movable = has_joints(world);
  for (const auto& [key, value] : from_world.attributes) {
    if (one_of(key, {"angle", "eulerseq", "discardvisual", "fusestatic"})) continue;
    const std::string robots = compiler.get(key, "MuJoCo's default");
    if (robots == value || (key != "coordinate" && !movable)) continue;
    problems.push_back(from_world.problem(fmt::format("{}=\"{}\"", key, value),
                                          fmt::format("the robot's setting, {} ({})", robots, robot.file)));
  }
  return compiler;
}

/// Solver settings from the robot, properties of the place from the world.
MjcfElement compose_option(const MjcfElement& world, const MjcfElement& robot,
                           std::vector<Problem>& problems) {
  const MjcfElement place = merged_section(world, "option");
  MjcfElement option = merged_section(robot, "option");
  for (const char* key : {"gravity", "wind", "magnetic", "density", "viscosity"}) {
    const std::string* value = place.find(key);
    if (value == nullptr) continue;
    const std::string* robots = option.find(key);
    if (robots != nullptr && numbers(*robots) != numbers(*value)) {
      problems.push_back(
          place.problem(fmt::format("{}=\"{}\"", key, *value),
                        fmt::format("the robot's, \"{}\" ({}), or none there", *robots, robot.file)));
    }
    option.set(key, *value);
  }
  return option;
}

/// Room for both: the larger of every size.
MjcfElement compose_size(const MjcfElement& world, const MjcfElement& robot) {
  MjcfElement size = merged_section(robot, "size");
  const MjcfElement from_world = merged_section(world, "size");
  for (const auto& [key, value] : from_world.attributes) {
    const std::string* robots = size.find(key);
    if (robots == nullptr || std::atof(robots->c_str()) < std::atof(value.c_str())) size.set(key, value);
  }
  return size;
}

/// What MuJoCo keeps apart when it looks names up.
std::string name_space(const std::string& section, const std::string& tag) {
  if (section == "actuator" || section == "sensor" || section == "equality" || section == "tendon")
    return section;
  return tag == "freejoint" ? "joint" : tag;
}

/// MuJoCo names meshes, textures and height fields without a name after their file.
std::string name_of(const MjcfElement& element) {
  if (const std::string* name = element.find("name")) return *name;
  if (!one_of(element.tag, {"mesh", "texture", "hfield", "skin"})) return "";
  return std::filesystem::path(element.get("file")).stem().string();
}

using Names = std::map<std::pair<std::string, std::string>, const MjcfElement*>;

Names names_of(const MjcfElement& root) {
  Names names;
  for (const MjcfElement& section : root.children) {
    if (!one_of(section.tag,
                {"asset", "worldbody", "contact", "equality", "tendon", "actuator", "sensor", "custom"})) {
      continue;
    }
    MjcfElement::walk(section, [&](const MjcfElement& element) {
      const std::string name = name_of(element);
      if (!name.empty()) names.emplace(std::pair(name_space(section.tag, element.tag), name), &element);
    });
  }
  return names;
}

void check_names(const MjcfElement& world, const MjcfElement& robot, std::vector<Problem>& problems) {
  const Names robots = names_of(robot);
  for (const auto& [key, element] : names_of(world)) {
    const auto same = robots.find(key);
    if (same == robots.end()) continue;
    problems.push_back(Problem{
        element->file, element->line, fmt::format("{} '{}'", key.first, key.second), "name used twice",
        fmt::format("another name than in {}:{}", same->second->file, same->second->line)});
  }
}

/// Bodies of the world that carry joints without having one: bases of arms.
std::vector<MjcfElement*> standing_bodies(MjcfElement& robot) {
  std::vector<MjcfElement*> found;
  for (MjcfElement& section : robot.children) {
    if (section.tag != "worldbody") continue;
    for (MjcfElement& body : section.children) {
      const bool own_joint = std::any_of(body.children.begin(), body.children.end(),
                                         [](const MjcfElement& child) { return child.tag == "joint"; });
      if (body.tag == "body" && !own_joint && has_joints(body)) found.push_back(&body);
    }
  }
  return found;
}

}  // namespace

MjcfElement compose_mjcf(MjcfElement world, MjcfElement robot, std::vector<MjcfElement> people) {
  std::vector<Problem> problems;
  check_names(world, robot, problems);
  MjcfElement scene{"mujoco", {{"model", world.get("model", "world")}}, {}, world.file, world.line};
  scene.children.push_back(compose_compiler(world, robot, problems));
  scene.children.push_back(compose_option(world, robot, problems));
  scene.children.push_back(compose_size(world, robot));
  if (!problems.empty()) throw InputError(std::move(problems));

  scope_defaults(world, "world");
  scope_defaults(robot, "robot");
  for (MjcfElement& section : world.children) {
    if (!one_of(section.tag, {"compiler", "option", "size", "keyframe"}))
      scene.children.push_back(std::move(section));
  }
  for (MjcfElement& section : robot.children) {
    if (!one_of(section.tag, {"compiler", "option", "size", "keyframe", "visual", "statistic"})) {
      scene.children.push_back(std::move(section));
    }
  }
  for (MjcfElement& person : people) {
    for (MjcfElement& section : person.children) scene.children.push_back(std::move(section));
  }
  return scene;
}

std::string robot_root_body(MjcfElement& robot) {
  const auto is_free = [](const MjcfElement& child) {
    return child.tag == "freejoint" || (child.tag == "joint" && child.get("type") == "free");
  };
  std::vector<MjcfElement*> found;
  MjcfElement::walk(robot, [&](MjcfElement& element) {
    if (element.tag == "body" && std::any_of(element.children.begin(), element.children.end(), is_free)) {
      found.push_back(&element);
    }
  });
  if (found.empty()) found = standing_bodies(robot);
  if (found.size() != 1) {
    const MjcfElement& where = found.empty() ? robot : *found.back();
    throw InputError(
        where.problem(fmt::format("{} bodies with a free joint", found.size()),
                      "one body with a free joint, the robot's root, or one that stands and carries "
                      "joints, the base of an arm"));
  }
  if (found.front()->find("name") == nullptr) found.front()->set("name", "robot");
  return found.front()->get("name");
}

}  // namespace groundloop::sim
