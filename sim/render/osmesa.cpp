#include <GL/osmesa.h>

#include <array>
#include <stdexcept>

#include "sim/render/gl_context.h"
#include "sim/render/library.h"

namespace groundloop::sim {
namespace {

struct OsMesa {
  Library library{"libOSMesa.so.8", "libosmesa6"};
  decltype(&OSMesaCreateContextExt) create =
      library.function<decltype(OSMesaCreateContextExt)>("OSMesaCreateContextExt");
  decltype(&OSMesaDestroyContext) destroy =
      library.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext");
  decltype(&OSMesaMakeCurrent) make_current =
      library.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
  decltype(&OSMesaGetCurrentContext) current =
      library.function<decltype(OSMesaGetCurrentContext)>("OSMesaGetCurrentContext");
  decltype(&OSMesaGetProcAddress) address =
      library.function<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress");
};

const OsMesa& osmesa() {
  static const OsMesa loaded;
  return loaded;
}

/// MuJoCo draws into a frame buffer of its own, so the context's buffer is only a formality.
class OsMesaContext : public GlContext {
 public:
  OsMesaContext() : context_(osmesa().create(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr) throw std::runtime_error("OSMesa gives no OpenGL context");
    make_current();
  }
  ~OsMesaContext() override { osmesa().destroy(context_); }
  OsMesaContext(const OsMesaContext&) = delete;
  OsMesaContext& operator=(const OsMesaContext&) = delete;

  void make_current() override {
    if (osmesa().current() == context_) return;
    if (osmesa().make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSize_px, kSize_px) == GL_FALSE) {
      throw std::runtime_error("OSMesa refuses its OpenGL context");
    }
  }
  std::string backend() const override { return "OSMesa"; }

 private:
  void (*address(const char* name) const)() override { return osmesa().address(name); }

  static constexpr int kSize_px = 16;
  OSMesaContext context_;
  std::array<unsigned char, 4 * kSize_px * kSize_px> buffer_{};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsMesaContext>(); }

}  // namespace groundloop::sim
