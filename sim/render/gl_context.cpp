#include "sim/render/gl_context.h"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>

namespace groundloop::sim {
namespace {

struct Choice {
  std::mutex mutex;
  Backend backend = Backend::kOsMesa;
  bool used = false;
};

Choice& choice() {
  static Choice the_choice;
  return the_choice;
}

}  // namespace

void choose_backend(Backend backend) {
  const std::lock_guard lock(choice().mutex);
  if (choice().used && choice().backend != backend) {
    throw std::logic_error("choose_backend: MuJoCo is bound to another backend already");
  }
  choice().backend = backend;
}

std::unique_ptr<GlContext> make_gl_context() {
  const std::lock_guard lock(choice().mutex);
  choice().used = true;
  return choice().backend == Backend::kEgl ? make_egl_context() : make_osmesa_context();
}

std::string GlContext::renderer() const {
  const GLubyte* text = function<const GLubyte*(GLenum)>("glGetString")(GL_RENDERER);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

std::string GlContext::version() const {
  const GLubyte* text = function<const GLubyte*(GLenum)>("glGetString")(GL_VERSION);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

int GlContext::samples_for(int asked) const {
  GLint most = 0, given = 0;
  GLuint buffer = 0;
  function<void(GLenum, GLint*)>("glGetIntegerv")(GL_MAX_SAMPLES, &most);
  function<void(GLsizei, GLuint*)>("glGenRenderbuffers")(1, &buffer);
  const auto bind = function<void(GLenum, GLuint)>("glBindRenderbuffer");
  bind(GL_RENDERBUFFER, buffer);
  function<void(GLenum, GLsizei, GLenum, GLsizei, GLsizei)>("glRenderbufferStorageMultisample")(
      GL_RENDERBUFFER, std::min(asked, most), GL_RGBA8, 1, 1);
  function<void(GLenum, GLenum, GLint*)>("glGetRenderbufferParameteriv")(GL_RENDERBUFFER,
                                                                         GL_RENDERBUFFER_SAMPLES, &given);
  bind(GL_RENDERBUFFER, 0);
  function<void(GLsizei, const GLuint*)>("glDeleteRenderbuffers")(1, &buffer);
  return given;
}

}  // namespace groundloop::sim
