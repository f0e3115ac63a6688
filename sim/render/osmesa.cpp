#include <GL/osmesa.h>

#include <array>
#include <stdexcept>

#include "sim/render/gl_context.h"

namespace groundloop::sim {
namespace {

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

/// MuJoCo draws into a frame buffer of its own, so the context's buffer is only a formality.
class OsMesaContext : public GlContext {
 public:
  OsMesaContext() : context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr) throw std::runtime_error("OSMesa gives no OpenGL context");
    make_current();
  }
  ~OsMesaContext() override { OSMesaDestroyContext(context_); }
  OsMesaContext(const OsMesaContext&) = delete;
  OsMesaContext& operator=(const OsMesaContext&) = delete;

  void make_current() override {
    if (OSMesaGetCurrentContext() == context_) return;
    if (OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSize_px, kSize_px) == GL_FALSE) {
      throw std::runtime_error("OSMesa refuses its OpenGL context");
    }
  }
  std::string backend() const override { return "OSMesa"; }

 private:
  static constexpr int kSize_px = 16;
  OSMesaContext context_;
  std::array<unsigned char, 4 * kSize_px * kSize_px> buffer_{};
};

}  // namespace

std::string GlContext::renderer() const { return gl_string(GL_RENDERER); }
std::string GlContext::version() const { return gl_string(GL_VERSION); }

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsMesaContext>(); }

}  // namespace groundloop::sim
