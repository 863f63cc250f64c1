// The drawing context of a stage: EGL without a window system, or OSMesa if EGL is missing. Both are opened
// with dlopen, so that no binary links GL.
#pragma once

#include <memory>
#include <mutex>
#include <string>

namespace enc::sim {

class DrawingContext {
 public:
  virtual ~DrawingContext() = default;
  virtual void make_current() const = 0;  // on the thread that made it
  [[nodiscard]] virtual const char* name() const = 0;
  [[nodiscard]] virtual void* function(const char* name) const = 0;  // OpenGL function; null if missing
};

// Hold this lock while you make, use or destroy a context of this module: one thread of the process draws at
// a time. Without it a benchmark once crashed in Mesa 22.3.6, in its check whether a drawing references a
// resource; that check includes the drawings of other threads' contexts.
[[nodiscard]] std::unique_lock<std::mutex> drawing_lock();

// EGL, else OSMesa; the environment variable ENCOUNTER_GL=egl or ENCOUNTER_GL=osmesa selects one. The context
// is current on return. All contexts of a process are of one kind, because MuJoCo looks OpenGL up once.
// Throws Error (kind device) with both messages.
[[nodiscard]] std::unique_ptr<DrawingContext> drawing_context();
// As in CameraModule. Draws nothing.
[[nodiscard]] std::string renderer_problem(const char* kind);
[[nodiscard]] std::string renderer_name(const char* kind);

}  // namespace enc::sim
