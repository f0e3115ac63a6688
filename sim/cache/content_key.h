#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace groundloop::sim {

/// SHA-256 of everything that some content follows from.
struct ContentKey {
  std::array<uint8_t, 32> bytes{};

  std::string hex() const;
  bool operator==(const ContentKey&) const = default;
};

/// Builds a key from values, in order. Texts and arrays carry their length, so that neighbours cannot run
/// into each other. A copy goes on from where the original is.
class KeyBuilder {
 public:
  KeyBuilder();
  ~KeyBuilder();
  KeyBuilder(const KeyBuilder& other);
  KeyBuilder& operator=(const KeyBuilder&) = delete;

  void add(std::string_view text);
  void add(const std::string& text) { add(std::string_view(text)); }
  void add(const char* text) { add(std::string_view(text)); }
  /// A number, truth value or enumerator.
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
    add_bytes(&value, sizeof value);
  }
  template <class T>
  requires(std::is_arithmetic_v<T>) void add(const T* values, size_t count) {
    add(static_cast<uint64_t>(count));
    add_bytes(values, count * sizeof(T));
  }

  ContentKey key() const;

 private:
  void add_bytes(const void* data, size_t size);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
