// Where a stage draws: EGL without a window system, or OSMesa where there is none. Both are opened with
// dlopen, so that nothing links GL.
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
  [[nodiscard]] virtual void* function(const char* name) const = 0;  // of OpenGL; null where there is none
};

// Whoever makes, uses or destroys a context of this module holds this meanwhile: one thread of the process
// draws at a time. Without it a benchmark crashed once in Mesa 22.3.6, where it asks whether a resource is
// referenced by a drawing: those of other threads' contexts are asked as well.
[[nodiscard]] std::unique_lock<std::mutex> drawing_lock();

// EGL, else OSMesa; the environment's ENCOUNTER_GL=egl or ENCOUNTER_GL=osmesa says which. Current when it
// returns. All contexts of a process are of one kind: MuJoCo looks OpenGL up once. Throws Error (kind device)
// with what both said.
[[nodiscard]] std::unique_ptr<DrawingContext> drawing_context();
// As CameraModule has it. Draws nothing.
[[nodiscard]] std::string renderer_problem(const char* kind);
[[nodiscard]] std::string renderer_name(const char* kind);

}  // namespace enc::sim
