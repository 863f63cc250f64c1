#include "sim/camera/context.h"

#include <cstdlib>
#include <string>

#include <dlfcn.h>

#include "core/base/error.h"
#include "sim/view/egl.h"

namespace enc::sim {
namespace {

template <class F>
F symbol(void* library, const char* name) {
  return reinterpret_cast<F>(dlsym(library, name));
}

class Egl final : public DrawingContext {
 public:
  void make_current() const override { context_.make_current(); }
  [[nodiscard]] const char* name() const override { return "EGL"; }
  [[nodiscard]] void* function(const char* name) const override {
    const auto address = symbol<void* (*)(const char*)>(RTLD_DEFAULT, "eglGetProcAddress");
    return address == nullptr ? nullptr : address(name);
  }

 private:
  OffscreenContext context_;
};

// The used part of GL/osmesa.h, which may be missing.
constexpr int kRgba = 0x1908;
constexpr unsigned kUnsignedByte = 0x1401;
using Create = void* (*)(unsigned format, int depth, int stencil, int accumulate, void* shared);
using MakeCurrent = unsigned char (*)(void* context, void* buffer, unsigned type, int width, int height);

class OsMesa final : public DrawingContext {
 public:
  OsMesa() : library_(dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_GLOBAL)) {
    if (library_ == nullptr)
      throw Error("libOSMesa.so.8 is not there; on Debian: apt-get install libosmesa6", {},
                  ErrorKind::device);
    const auto create = symbol<Create>(library_, "OSMesaCreateContextExt");
    current_ = symbol<MakeCurrent>(library_, "OSMesaMakeCurrent");
    destroy_ = symbol<void (*)(void*)>(library_, "OSMesaDestroyContext");
    if (create == nullptr || current_ == nullptr || destroy_ == nullptr)
      throw Error("libOSMesa.so.8 lacks functions", {}, ErrorKind::device);
    context_ = create(kRgba, 24, 8, 0, nullptr);
    if (context_ == nullptr) throw Error("OSMesa makes no OpenGL context", {}, ErrorKind::device);
    make_current();
  }
  ~OsMesa() override { destroy_(context_); }
  OsMesa(const OsMesa&) = delete;
  OsMesa& operator=(const OsMesa&) = delete;

  void make_current() const override {
    if (current_(context_, window_, kUnsignedByte, kSide, kSide) == 0)
      throw Error("OSMesa makes no OpenGL context current", {}, ErrorKind::device);
  }
  [[nodiscard]] const char* name() const override { return "OSMesa"; }
  [[nodiscard]] void* function(const char* name) const override {
    const auto address = symbol<void* (*)(const char*)>(library_, "OSMesaGetProcAddress");
    return address == nullptr ? nullptr : address(name);
  }

 private:
  static constexpr int kSide = 16;  // px; MuJoCo draws into its own buffer, never into this one
  void* library_ = nullptr;
  void* context_ = nullptr;
  MakeCurrent current_ = nullptr;
  void (*destroy_)(void*) = nullptr;
  mutable unsigned char window_[4 * kSide * kSide]{};
};

// `mujoco_gl` selects the library from which MuJoCo takes OpenGL's functions.
template <class Context>
std::unique_ptr<DrawingContext> made(const char* mujoco_gl) {
  auto context = std::make_unique<Context>();
  setenv("MUJOCO_GL", mujoco_gl, 1);
  return context;
}

}  // namespace

std::unique_lock<std::mutex> drawing_lock() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

std::unique_ptr<DrawingContext> drawing_context() {
  // Mesa's software rasteriser draws in this thread instead of one more for each core.
  setenv("LP_NUM_THREADS", "0", 0);
  const char* wanted = std::getenv("ENCOUNTER_GL");
  const std::string kind = wanted == nullptr ? "" : wanted;
  if (kind == "egl") return made<Egl>("egl");
  if (kind == "osmesa") return made<OsMesa>("osmesa");
  if (!kind.empty()) throw Error("ENCOUNTER_GL is egl or osmesa, not '" + kind + "'");
  std::string why;
  try {
    return made<Egl>("egl");
  } catch (const Error& e) {
    why = e.what();
  }
  try {
    return made<OsMesa>("osmesa");
  } catch (const Error& e) {
    throw Error(why + "; nor with OSMesa: " + e.what(), {}, ErrorKind::device);
  }
}

namespace {

std::string name_of(const DrawingContext& context) {
  constexpr unsigned kRenderer = 0x1F01;  // GL_RENDERER
  context.make_current();
  using GetString = const unsigned char* (*)(unsigned);
  const auto get = reinterpret_cast<GetString>(context.function("glGetString"));
  const unsigned char* name = get == nullptr ? nullptr : get(kRenderer);
  return name == nullptr ? "unknown" : reinterpret_cast<const char*>(name);
}

std::string asked(const char* kind) {
  const auto lock = drawing_lock();
  setenv("LP_NUM_THREADS", "0", 0);
  return std::string(kind) == "egl" ? name_of(Egl()) : name_of(OsMesa());
}

}  // namespace

std::string renderer_problem(const char* kind) {
  try {
    (void)asked(kind);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

std::string renderer_name(const char* kind) {
  try {
    return asked(kind);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace enc::sim
