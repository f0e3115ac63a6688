#include "sim/scenario/schema.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/scenario/scenario.h"

namespace groundloop::sim {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
concept Describable = !std::is_arithmetic_v<T> && requires(T & value, ConfigReader& reader) {
  value.visit(reader);
};

/// Visits a default-constructed struct and writes down what each key may hold.
class SchemaWriter {
 public:
  template <class T>
  void operator()(const char* key, T& value, const Field& field = {}) {
    Json entry = describe(value, field);
    if (*field.doc != 0) entry["description"] = field.doc;
    properties_[key] = std::move(entry);
    if (field.required) required_.push_back(key);
  }

  template <class T>
  static Json object(T value) {
    SchemaWriter writer;
    value.visit(writer);
    Json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", writer.properties_}};
    if (!writer.required_.empty()) schema["required"] = writer.required_;
    if constexpr (requires { T::kExactlyOneMember; }) schema["minProperties"] = schema["maxProperties"] = 1;
    return schema;
  }

 private:
  template <class T>
  static Json describe(const T& value, const Field& field) {
    if constexpr (config_detail::IsOptional<T>::value) {
      return without_default(describe(typename T::value_type{}, field));
    } else if constexpr (config_detail::IsVector<T>::value) {
      return {{"type", "array"}, {"items", without_default(describe(typename T::value_type{}, field))}};
    } else if constexpr (config_detail::IsStringMap<T>::value) {
      return {{"type", "object"}, {"additionalProperties", scalar()}};
    } else if constexpr (HasShortForm<T>) {
      return {{"anyOf", Json::array({{{"type", "string"}}, object(value)})}};
    } else if constexpr (Describable<T>) {
      return object(value);
    } else if constexpr (std::is_enum_v<T>) {
      return enumeration(value);
    } else {
      return leaf(value, field);
    }
  }

  /// Options of the core are read as text, whatever they look like in YAML.
  static Json scalar() { return {{"type", Json::array({"string", "number", "boolean"})}}; }

  template <class E>
  static Json enumeration(E value) {
    Json names = Json::array(), initial;
    for (const auto& [candidate, name] : EnumNames<E>::names) {
      names.push_back(name);
      if (candidate == value) initial = name;
    }
    return {{"enum", names}, {"default", initial}};
  }

  template <class T>
  static Json leaf(const T& value, const Field& field) {
    Json schema;
    if constexpr (std::is_same_v<T, bool>)
      schema["type"] = "boolean";
    else if constexpr (std::is_integral_v<T>)
      schema["type"] = "integer";
    else if constexpr (std::is_floating_point_v<T>)
      schema["type"] = "number";
    else
      schema["type"] = "string";
    if constexpr (std::is_unsigned_v<T> && !std::is_same_v<T, bool>) schema["minimum"] = 0;
    if (std::isfinite(field.min)) schema["minimum"] = field.min;
    if (std::isfinite(field.max)) schema["maximum"] = field.max;
    if (!field.required) schema["default"] = value;
    return schema;
  }

  static Json without_default(Json schema) {
    schema.erase("default");
    return schema;
  }

  Json properties_ = Json::object();
  std::vector<std::string> required_;
};

}  // namespace

std::string scenario_schema() {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "groundloop scenario"},
                 {"description", "What happens in a run, and what must come out."}};
  schema.update(SchemaWriter::object(Scenario{}));
  return schema.dump(2) + "\n";
}

}  // namespace groundloop::sim
