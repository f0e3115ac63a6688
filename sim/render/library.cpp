#include "sim/render/library.h"

#include <dlfcn.h>

#include <stdexcept>

namespace groundloop::sim {

Library::Library(const char* file, const char* package)
    : file_(file), handle_(dlopen(file, RTLD_NOW | RTLD_GLOBAL)) {
  if (handle_ != nullptr) return;
  throw std::runtime_error(std::string(dlerror()) + " (Debian package " + package + ")");
}

void* Library::symbol(const char* name) const {
  void* address = dlsym(handle_, name);
  if (address == nullptr) throw std::runtime_error(file_ + " has no " + name);
  return address;
}

}  // namespace groundloop::sim
