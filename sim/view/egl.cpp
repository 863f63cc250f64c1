#include "sim/view/egl.h"

// No X11 types: the surfaceless platform does not need them.
#define EGL_NO_X11
#include <cstdlib>
#include <string>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include "core/base/error.h"

namespace enc::sim {
namespace {

[[noreturn]] void no_picture(const std::string& why) {
  throw Error("no picture can be drawn: " + why + "; on Debian: apt-get install libegl1 libgl1-mesa-dri", {},
              ErrorKind::device);
}

template <class F>
F function(void* library, const char* name) {
  F found = reinterpret_cast<F>(dlsym(library, name));
  if (found == nullptr) no_picture(std::string("libEGL.so.1 has no ") + name);
  return found;
}

EGLDisplay surfaceless(void* egl) {
  const auto address = function<decltype(&eglGetProcAddress)>(egl, "eglGetProcAddress");
  const auto display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address("eglGetPlatformDisplayEXT"));
  return display == nullptr ? EGL_NO_DISPLAY
                            : display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

}  // namespace

OffscreenContext::OffscreenContext() {
  // Mesa's software rasteriser draws in this thread instead of one more for each core; the picture does not
  // change.
  setenv("LP_NUM_THREADS", "0", 0);
  // Global: MuJoCo's renderer looks eglGetProcAddress up among the program's symbols.
  library_ = dlopen("libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
  if (library_ == nullptr) no_picture("libEGL.so.1 is not there");
  display_ = surfaceless(library_);
  if (display_ == EGL_NO_DISPLAY ||
      !function<decltype(&eglInitialize)>(library_, "eglInitialize")(display_, nullptr, nullptr))
    no_picture("EGL has no surfaceless display");
  function<decltype(&eglBindAPI)>(library_, "eglBindAPI")(EGL_OPENGL_API);
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!function<decltype(&eglChooseConfig)>(library_, "eglChooseConfig")(display_, wanted, &config, 1,
                                                                         &count) ||
      count == 0)
    no_picture("EGL offers no OpenGL");
  context_ = function<decltype(&eglCreateContext)>(library_, "eglCreateContext")(display_, config,
                                                                                 EGL_NO_CONTEXT, nullptr);
  if (context_ == EGL_NO_CONTEXT) no_picture("EGL makes no OpenGL context");
  make_current();
}

void OffscreenContext::make_current() const {
  const auto current = function<decltype(&eglMakeCurrent)>(library_, "eglMakeCurrent");
  if (!current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    no_picture("EGL makes no OpenGL context current");
}

// The library stays open: Mesa leaves thread-local data behind that outlives a dlclose. So does the display:
// EGL has one for the whole process, and other contexts may live on it.
OffscreenContext::~OffscreenContext() {
  function<decltype(&eglMakeCurrent)>(library_, "eglMakeCurrent")(display_, EGL_NO_SURFACE, EGL_NO_SURFACE,
                                                                  EGL_NO_CONTEXT);
  function<decltype(&eglDestroyContext)>(library_, "eglDestroyContext")(display_, context_);
}

}  // namespace enc::sim
