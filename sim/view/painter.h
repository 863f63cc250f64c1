// Paints ViewRequests of one model with one renderer, for the picture in a file, every frame of a film, and
// the window.
#pragma once

#include <optional>
#include <vector>

#include "sim/bodies/mujoco.h"
#include "sim/view/renderer.h"
#include "sim/view/view.h"

namespace enc::sim {

struct PaintSettings {
  int shadow_size = 0;  // px of the shadow map; 0: no shadows
  // Round bodies: parts along the axis, and around it.
  int stacks = 48, slices = 64;
  mjtFontScale letters = mjFONTSCALE_100;
  int width = 0, height = 0;  // px off the screen; 0: into the window
};

// Needs the OpenGL context that was current at its construction.
class Painter {
 public:
  // Throws Error (kind device) if memory is short.
  Painter(const ViewRequest& request, const PaintSettings& settings);

  [[nodiscard]] bool is_of(const mjModel* model) const { return of_ == model; }
  // Throws Error (kind device) for too many geoms.
  void paint(const ViewRequest& request, const mjrRect& where);
  // Paints by another camera, with the deformation of the last picture.
  void paint_again(const ViewRequest& request, const mjrRect& where);
  // Sets scene() for a request without painting it.
  void look(const ViewRequest& request);
  // The last picture's scene and context.
  [[nodiscard]] const mjvScene& scene() const { return renderer_.scene; }
  [[nodiscard]] const mjrContext& context() const { return renderer_.context; }
  // The point of the model at a share of the width and of the height, with these data and the last picture's
  // camera; unset: background.
  [[nodiscard]] std::optional<Point<'W'>> seen_at(double across, double up, double aspect,
                                                  const mjData* data) const;

 private:
  void dent(const ViewRequest& request);
  void restore();

  const mjModel* of_;
  ModelPtr model_;  // the picture's own model, which can be deformed
  bool shadows_;
  Renderer renderer_;
  std::vector<float> whole_vertices_, whole_normals_;  // all meshes, before the first deformation
  int dented_ = -1;                                    // mesh
};

}  // namespace enc::sim
