#pragma once

#include <memory>
#include <string>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Who gives an OpenGL context without a display or a GPU. Both are Mesa's llvmpipe and give the same pixels.
enum class Backend {
  kOsMesa,  ///< libOSMesa: renders into memory
  kEgl,     ///< EGL on Mesa's surfaceless platform
};

/// Chooses the backend of this process; OSMesa when it is never called. MuJoCo binds to the first one that
/// makes a context.
/// @throws std::logic_error when a context of another backend was made before
void choose_backend(Backend backend);

/// An off-screen OpenGL context that MuJoCo can draw with.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes it the calling thread's context; cheap when it already is.
  virtual void make_current() = 0;
  virtual std::string backend() const = 0;
  /// An OpenGL function of the current context by its name; never null.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }

  std::string renderer() const;  ///< GL_RENDERER of the current context
  std::string version() const;   ///< GL_VERSION of the current context
  /// Samples a pixel that a multisampled buffer of the current context gets when so many are asked for.
  int samples_for(int asked) const;

 private:
  using Address = void (*)();
  virtual Address address(const char* name) const = 0;
};

/// A context of the chosen backend, current in the calling thread.
/// @throws std::runtime_error when its library is missing or gives no context
std::unique_ptr<GlContext> make_gl_context();

// The backends, each in a file of its own.
std::unique_ptr<GlContext> make_osmesa_context();
std::unique_ptr<GlContext> make_egl_context();

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::Backend> {
  static constexpr std::array<std::pair<sim::Backend, const char*>, 2> names = {
      {{sim::Backend::kOsMesa, "osmesa"}, {sim::Backend::kEgl, "egl"}}};
};
}  // namespace groundloop
