#pragma once

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace groundloop {

/// One thing wrong in an input file: says file, line, key, the value found and what was wanted.
struct Problem {
  std::string file;
  int line = 0;  ///< from 1; 0 when the value has no line (a command-line option)
  std::string key;
  std::string value;
  std::string wanted;

  /// "lab.yaml:4: plan.speed_mps: fast: wanted a number"
  std::string text() const;
};

/// Bad input. Carries every problem found, not only the first. Programs answer with exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// What a configured value must satisfy. A struct describes itself by one line a member:
///   template <class Archive> void visit(Archive& a) { a("speed_mps", speed_mps, {.min = 0, .max = 2}); }
/// The same line serves reading, writing and the JSON schema, so a YAML key cannot differ from its member.
struct Field {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool required = false;
  const char* doc = "";
};

/// Specialise for every enum that appears in a file: static constexpr std::array<std::pair<E, const char*>,
/// N> names.
template <class E>
struct EnumNames;

class ConfigReader;
template <class T>
concept Visitable = requires(T& value, ConfigReader& reader) {
  value.visit(reader);
};
template <class T>
concept Checkable = requires(const T& value, ConfigReader& reader) {
  value.check(reader);
};
/// A struct of which one text stands for the whole: `world: lab.xml` is short for `world: {file: lab.xml}`.
template <class T>
concept HasShortForm = requires(T& value) {
  { value.short_form() } -> std::same_as<std::string&>;
};

/// Reads one YAML map into a struct. Missing keys keep the struct's value; unknown keys, wrong types and
/// values out of range are collected. A struct may add `void check(ConfigReader&) const` for rules over
/// several keys.
class ConfigReader {
 public:
  /// @param path   dotted key of this map inside the file, "" at the root
  /// @param line   line to report for everything, where the nodes' own marks mean nothing (a value given by
  /// key)
  ConfigReader(const YAML::Node& node, std::string file, std::string path, std::vector<Problem>* problems,
               std::optional<int> line = std::nullopt);

  template <class T>
  void operator()(const char* key, T& value, const Field& field = {}) {
    known_.insert(key);
    const YAML::Node child = node_.IsMap() ? node_[key] : YAML::Node(YAML::NodeType::Undefined);
    if (!child.IsDefined() || child.IsNull()) {
      if (field.required && !overlay_) problem(key, "missing", describe(value, field));
      return;
    }
    read(child, key, value, field);
  }

  /// Records a problem of this map's own: line and value are looked up by key ("" names the map itself).
  void problem(const std::string& key, const std::string& wanted);
  void problem(const std::string& key, const std::string& value, const std::string& wanted);
  /// True when the map holds the key.
  bool has(const std::string& key) const;
  /// Reports the keys that nothing asked for, with the nearest known one.
  void finish();
  /// An overlay gives only some of the keys, so required ones may be missing.
  void set_overlay(bool overlay) { overlay_ = overlay; }
  const std::string& file() const { return file_; }

 private:
  template <class T>
  void read(const YAML::Node& child, const std::string& key, T& value, const Field& field);
  template <class T>
  static std::string describe(const T& value, const Field& field);
  static std::string describe_range(const std::string& what, const Field& field);
  void wrong(const YAML::Node& child, const std::string& key, const std::string& wanted);
  std::string path_of(const std::string& key) const;
  int line_of(const YAML::Node& node) const;

  YAML::Node node_;
  std::string file_;
  std::string path_;
  std::vector<Problem>* problems_;
  std::optional<int> line_;
  bool overlay_ = false;
  std::set<std::string> known_;
};

namespace config_detail {
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsStringMap : std::false_type {};
template <class T>
struct IsStringMap<std::map<std::string, T>> : std::true_type {};

template <class E>
std::string enum_choices() {
  std::string text;
  for (const auto& [value, name] : EnumNames<E>::names)
    text += (text.empty() ? "" : ", ") + std::string(name);
  return "one of: " + text;
}
}  // namespace config_detail

template <class T>
std::string ConfigReader::describe(const T&, const Field& field) {
  if constexpr (std::is_enum_v<T>)
    return config_detail::enum_choices<T>();
  else if constexpr (std::is_same_v<T, bool>)
    return "true or false";
  else if constexpr (std::is_integral_v<T>)
    return describe_range("a whole number", field);
  else if constexpr (std::is_floating_point_v<T>)
    return describe_range("a number", field);
  else if constexpr (std::is_same_v<T, std::string>)
    return "a text";
  else if constexpr (config_detail::IsVector<T>::value)
    return "a list";
  else if constexpr (HasShortForm<T>)
    return "a text, or a map of keys and values";
  else
    return "a map of keys and values";
}

template <class T>
void ConfigReader::read(const YAML::Node& child, const std::string& key, T& value, const Field& field) {
  if constexpr (config_detail::IsOptional<T>::value) {
    typename T::value_type inner = value.value_or(typename T::value_type{});
    read(child, key, inner, field);
    value = std::move(inner);
  } else if constexpr (config_detail::IsVector<T>::value) {
    if (!child.IsSequence()) return wrong(child, key, "a list");
    value.clear();
    for (size_t i = 0; i < child.size(); ++i) {
      typename T::value_type item{};
      read(child[i], key + "[" + std::to_string(i) + "]", item, field);
      value.push_back(std::move(item));
    }
  } else if constexpr (config_detail::IsStringMap<T>::value) {
    if (!child.IsMap()) return wrong(child, key, "a map of keys and values");
    for (const auto& entry : child) {
      const auto name = entry.first.as<std::string>();
      read(entry.second, key + "." + name, value[name], field);
    }
  } else if constexpr (Visitable<T>) {
    if constexpr (HasShortForm<T>) {
      if (child.IsScalar()) {
        value = T{};
        return read(child, key, value.short_form(), field);
      }
    }
    if (!child.IsMap()) return wrong(child, key, describe(value, field));
    ConfigReader inner(child, file_, path_of(key), problems_, line_);
    inner.set_overlay(overlay_);
    value.visit(inner);
    inner.finish();
    if constexpr (Checkable<T>) value.check(inner);
  } else if constexpr (std::is_enum_v<T>) {
    if (child.IsScalar()) {
      for (const auto& [candidate, name] : EnumNames<T>::names) {
        if (child.Scalar() == name) {
          value = candidate;
          return;
        }
      }
    }
    wrong(child, key, describe(value, field));
  } else {
    T parsed{};
    if (!child.IsScalar() || !YAML::convert<T>::decode(child, parsed)) {
      return wrong(child, key, describe(value, field));
    }
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const auto number = static_cast<double>(parsed);
      if (!(number >= field.min && number <= field.max)) return wrong(child, key, describe(value, field));
    }
    value = std::move(parsed);
  }
}

/// Parses a file. Throws InputError naming the file (missing, unreadable) or file and line (not YAML).
YAML::Node load_yaml_file(const std::string& file);

/// Reads a whole document into a struct; problems are appended, the caller decides when to throw.
template <Visitable T>
void read_config(const YAML::Node& node, const std::string& file, T& value, std::vector<Problem>& problems) {
  ConfigReader reader(node, file, "", &problems);
  value.visit(reader);
  reader.finish();
  if constexpr (Checkable<T>) value.check(reader);
}

/// Sets one value by its dotted key, as in `--set tracking.max_features=400`. `origin` and `line` go into
/// messages.
YAML::Node nested_node(const std::string& dotted_key, const YAML::Node& value);
template <Visitable T>
void set_by_key(T& value, const std::string& dotted_key, const YAML::Node& new_value,
                const std::string& origin, int line, std::vector<Problem>& problems) {
  ConfigReader reader(nested_node(dotted_key, new_value), origin, "", &problems, line);
  reader.set_overlay(true);
  value.visit(reader);
  reader.finish();
  if constexpr (Checkable<T>) value.check(reader);
}

/// Writes a struct as YAML: every key with its resolved value, in the order of visit().
class ConfigWriter {
 public:
  explicit ConfigWriter(YAML::Emitter& out) : out_(out) {}

  template <class T>
  void operator()(const char* key, T& value, const Field& = {}) {
    if constexpr (config_detail::IsOptional<T>::value) {
      if (!value) return;
    }
    out_ << YAML::Key << key << YAML::Value;
    write(value);
  }

  template <class T>
  void write(T& value) {
    if constexpr (config_detail::IsOptional<T>::value) {
      write(*value);
    } else if constexpr (config_detail::IsVector<T>::value) {
      out_ << YAML::BeginSeq;
      for (auto& item : value) write(item);
      out_ << YAML::EndSeq;
    } else if constexpr (config_detail::IsStringMap<T>::value) {
      out_ << YAML::BeginMap;
      for (auto& [name, item] : value) {
        out_ << YAML::Key << name << YAML::Value;
        write(item);
      }
      out_ << YAML::EndMap;
    } else if constexpr (Visitable<T>) {
      if constexpr (HasShortForm<T>) {
        if (!value.short_form().empty()) return write(value.short_form());
      }
      out_ << YAML::BeginMap;
      value.visit(*this);
      out_ << YAML::EndMap;
    } else if constexpr (std::is_enum_v<T>) {
      for (const auto& [candidate, name] : EnumNames<T>::names) {
        if (candidate == value) out_ << name;
      }
    } else {
      out_ << value;
    }
  }

 private:
  YAML::Emitter& out_;
};

template <Visitable T>
std::string to_yaml(T value) {
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  ConfigWriter writer(out);
  writer.write(value);
  return std::string(out.c_str()) + "\n";
}

}  // namespace groundloop
