// Puts ViewRequests into MuJoCo's scene and paints them, for the picture in a file, every frame of a film,
// and the window, which share these functions.
#pragma once

#include <optional>
#include <vector>

#include "sim/bodies/mujoco.h"
#include "sim/view/view.h"

namespace enc::sim {

inline constexpr int kRoom = 1000;  // geoms
// m, distance of the white backdrop; translucent geoms need something to mix with.
inline constexpr double kBackdrop = 4.0;

// A copy of the model with settings for pictures; the physics never sees it. `shadow_size`: size of the
// shadow map, px. `stacks`, `slices`: parts of a round body, along its axis and around it.
[[nodiscard]] ModelPtr picture_model(const ViewRequest& request, int shadow_size, int stacks, int slices);
// Adds the model's bodies, camera and light. Throws Error (kind device) for too many geoms, as the functions
// below do.
void aim(mjvScene& scene, const mjModel* model, const ViewRequest& request, bool shadows);
// Adds a wall that fills the background.
void add_backdrop(mjvScene& scene);
// Adds rods, boxes, arrows, signs and the floor.
void add_extras(mjvScene& scene, const ViewRequest& request);

struct PaintSettings {
  int shadow_size = 0;  // px of the shadow map; 0: no shadows
  // Round bodies: parts along the axis, and around it.
  int stacks = 48, slices = 64;
  mjtFontScale letters = mjFONTSCALE_100;
  int width = 0, height = 0;  // px off the screen; 0: into the window
};

// Paints ViewRequests of one model with one renderer. Needs the OpenGL context that was current at its
// construction.
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
