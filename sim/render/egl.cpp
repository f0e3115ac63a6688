#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstdlib>
#include <stdexcept>

#include "sim/render/gl_context.h"
#include "sim/render/library.h"

namespace groundloop::sim {
namespace {

/// The one display of the process: Mesa's surfaceless platform, drawn by the processor.
struct Egl {
  Library library{"libEGL.so.1", "libegl1"};
  decltype(&eglBindAPI) bind_api = library.function<decltype(eglBindAPI)>("eglBindAPI");
  decltype(&eglCreateContext) create = library.function<decltype(eglCreateContext)>("eglCreateContext");
  decltype(&eglDestroyContext) destroy = library.function<decltype(eglDestroyContext)>("eglDestroyContext");
  decltype(&eglMakeCurrent) make_current = library.function<decltype(eglMakeCurrent)>("eglMakeCurrent");
  decltype(&eglGetCurrentContext) current =
      library.function<decltype(eglGetCurrentContext)>("eglGetCurrentContext");
  decltype(&eglGetProcAddress) address = library.function<decltype(eglGetProcAddress)>("eglGetProcAddress");
  EGLDisplay display = nullptr;
  EGLConfig config = nullptr;

  Egl() {
    // A machine with a GPU would draw other pixels.
    setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1);
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address("eglGetPlatformDisplayEXT"));
    if (get_display != nullptr) {
      display = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);  // EGL_DEFAULT_DISPLAY
    }
    EGLint major = 0, minor = 0;
    if (display == nullptr ||
        library.function<decltype(eglInitialize)>("eglInitialize")(display, &major, &minor) == EGL_FALSE) {
      throw std::runtime_error("EGL has no surfaceless platform (Debian package libegl-mesa0)");
    }
    constexpr EGLint kWanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                  EGL_NONE};
    EGLint found = 0;
    library.function<decltype(eglChooseConfig)>("eglChooseConfig")(display, kWanted, &config, 1, &found);
    if (found == 0) throw std::runtime_error("EGL offers no OpenGL (Debian package libgl1-mesa-dri)");
  }
};

const Egl& egl() {
  static const Egl loaded;
  return loaded;
}

class EglContext : public GlContext {
 public:
  EglContext() {
    egl().bind_api(EGL_OPENGL_API);  // of the calling thread
    context_ = egl().create(egl().display, egl().config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) throw std::runtime_error("EGL gives no OpenGL context");
    make_current();
  }
  ~EglContext() override {
    if (egl().current() == context_) {
      egl().make_current(egl().display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl().destroy(egl().display, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    if (egl().current() == context_) return;
    if (egl().make_current(egl().display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
      throw std::runtime_error("EGL refuses its OpenGL context");
    }
  }
  std::string backend() const override { return "EGL surfaceless"; }

 private:
  void (*address(const char* name) const)() override { return egl().address(name); }

  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> make_egl_context() { return std::make_unique<EglContext>(); }

}  // namespace groundloop::sim
