// A pointing hand: a finger made of an exact half sphere and of widening cylinders; the rest of the hand and
// a sleeve as two meshes.
#pragma once

#include <vector>

#include "sim/bodies/mujoco.h"
#include "sim/camera/stage.h"

namespace enc::sim {

// Mesh of a hand with a finger 16 mm wide, m: x from knuckle to tip, y to the thumb, z out of its back;
// origin in the middle of the tip's cap.
struct HandMesh {
  std::vector<float> vertices, normals;
  std::vector<int> faces;
};
[[nodiscard]] HandMesh bare_hand();    // without the straight finger
[[nodiscard]] HandMesh sleeve_mesh();  // sleeve of an arm that is not bare
[[nodiscard]] HandMesh unit_tube();    // 1 m of radius and length, about the origin, along x

// The hand's x, y and z as columns, in C. If `along` has zero length, the hand points up.
[[nodiscard]] Mat3 hand_axes(const HandPose& pose);

// Adds a hand and things to a picture of a model from scenery_model().
class HandDrawing {
 public:
  // Removes the hand's own geoms from a new picture.
  HandDrawing(const mjModel* model, mjvScene& scene);
  // Replaces everything but the background by `shown`.
  void show(const CameraScene& shown, mjvScene& scene);
  // Queries about the last `shown`.
  [[nodiscard]] bool is_skin(int geom) const {
    return geom >= background_ && geom < things_ && geom != background_ + sleeve_at_;
  }
  [[nodiscard]] bool is_thing(int geom) const { return geom >= things_; }
  [[nodiscard]] int background() const { return background_; }  // number of geoms

 private:
  void add_hand(const HandPose& pose, const HandLook& look, mjvScene& scene) const;
  void add_thing(const Thing& thing, mjvScene& scene) const;
  void add_finger(const HandPose& pose, const HandLook& look, mjvScene& scene) const;
  void add_mesh(const mjvGeom& mesh, const Vec3& at, const Mat3& axes, const Rgb& colour,
                mjvScene& scene) const;

  const mjModel* model_;
  mjvGeom skin_, sleeve_, tube_;
  int background_ = 0, sleeve_at_ = 0, things_ = 0;  // geoms
};

}  // namespace enc::sim
