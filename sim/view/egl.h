// An OpenGL context without a screen: EGL's surfaceless platform, opened with dlopen so that nothing links
// GL.
#pragma once

namespace enc::sim {

class OffscreenContext {
 public:
  // Throws Error (kind device) that names the Debian packages, where there is no EGL or no driver.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

 private:
  void* library_ = nullptr;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace enc::sim
