// An OpenGL context without a screen: EGL's surfaceless platform, opened with dlopen so that nothing links
// GL.
#pragma once

namespace enc::sim {

// Made current for the thread that makes it. Several may live at a time.
class OffscreenContext {
 public:
  // Throws Error (kind device) that names the Debian packages, where there is no EGL or no driver.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  // Draws into this one from now on. On the thread that made it.
  void make_current() const;

 private:
  void* library_ = nullptr;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace enc::sim
