// MuJoCo's classic renderer and its scene, drawing into the OpenGL context that is current: into its window,
// or off the screen.
#pragma once

#include "sim/bodies/mujoco.h"

namespace enc::sim {

// Frees both, the context of drawing first, while OpenGL's is still there.
struct Renderer {
  mjvScene scene;
  mjrContext context;

  // Into the window. `room`: of geoms, most.
  Renderer(const mjModel* model, int room, mjtFontScale letters) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_makeScene(model, &scene, room);
    mjr_makeContext(model, &context, letters);
    mjr_setBuffer(mjFB_WINDOW, &context);
  }
  // Off the screen. Pixels.
  Renderer(const mjModel* model, int room, mjtFontScale letters, int width, int height)
      : Renderer(model, room, letters) {
    mjr_resizeOffscreen(width, height, &context);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
  }
  ~Renderer() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
};

}  // namespace enc::sim
