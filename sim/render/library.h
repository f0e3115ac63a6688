#pragma once

#include <string>

namespace groundloop::sim {

/// A shared library that is loaded when it is first needed, and stays. Its symbols become the process's own:
/// that is where MuJoCo looks for its OpenGL.
class Library {
 public:
  /// @param package  Debian package that holds it, for the message
  /// @throws std::runtime_error
  Library(const char* file, const char* package);

  /// @throws std::runtime_error when there is no such symbol
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;
  std::string file_;
  void* handle_;
};

}  // namespace groundloop::sim
