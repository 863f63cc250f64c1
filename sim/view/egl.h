// An OpenGL context without a screen: EGL's surfaceless platform, opened with dlopen so that no binary links
// GL.
#pragma once

namespace enc::sim {

// Becomes current on the thread that makes it. Several contexts may coexist.
class OffscreenContext {
 public:
  // Throws Error (kind device) that names the Debian packages, if EGL or a driver is missing.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  // Drawing goes to this context from now on. Call it on the thread that made it.
  void make_current() const;

 private:
  void* library_ = nullptr;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace enc::sim
