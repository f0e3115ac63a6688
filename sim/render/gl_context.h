#pragma once

#include <memory>
#include <string>

namespace groundloop::sim {

/// An off-screen OpenGL context that MuJoCo can draw with. The seam for further backends.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes it the calling thread's context; cheap when it already is.
  virtual void make_current() = 0;
  virtual std::string backend() const = 0;

  std::string renderer() const;  ///< GL_RENDERER of the current context
  std::string version() const;   ///< GL_VERSION of the current context
};

/// @throws std::runtime_error when Mesa gives no context
std::unique_ptr<GlContext> make_osmesa_context();

}  // namespace groundloop::sim
