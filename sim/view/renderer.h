// MuJoCo's classic renderer and its scene, drawing into the current OpenGL context: into its window, or off
// the screen.
#pragma once

#include "sim/bodies/mujoco.h"

namespace enc::sim {

// Frees both, the drawing context first, while OpenGL's still exists.
struct Renderer {
  mjvScene scene;
  mjrContext context;

  // `room`: most geoms. `width`, `height`: px off the screen; 0: into the window.
  Renderer(const mjModel* model, int room, mjtFontScale letters, int width, int height) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_makeScene(model, &scene, room);
    mjr_makeContext(model, &context, letters);
    const bool off_screen = width > 0 && height > 0;
    if (off_screen) mjr_resizeOffscreen(width, height, &context);
    mjr_setBuffer(off_screen ? mjFB_OFFSCREEN : mjFB_WINDOW, &context);
  }
  ~Renderer() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
};

}  // namespace enc::sim
