// A pointing hand: a finger out of half a sphere, exactly, and of cylinders that widen; the rest of the hand
// and a sleeve as two meshes.
#pragma once

#include <vector>

#include "sim/bodies/mujoco.h"
#include "sim/camera/stage.h"

namespace enc::sim {

// Of a hand whose finger is 16 mm wide, m: x from knuckle to tip, y to the thumb, z out of its back; from the
// middle of the tip's cap.
struct HandMesh {
  std::vector<float> vertices, normals;
  std::vector<int> faces;
};
[[nodiscard]] HandMesh bare_hand();    // without the straight finger
[[nodiscard]] HandMesh sleeve_mesh();  // of an arm that is not bare
[[nodiscard]] HandMesh unit_tube();    // 1 m of radius and length, about the origin, along x

// Its x, y and z as columns, in C. `along` of no length points up.
[[nodiscard]] Mat3 hand_axes(const HandPose& pose);

// Puts a hand, and things, into a picture of a model that scenery_model() made.
class HandDrawing {
 public:
  // Takes the hand's own geoms out of a picture that was just made.
  HandDrawing(const mjModel* model, mjvScene& scene);
  // Puts in what is shown, in place of what was there but the background.
  void show(const Shown& shown, mjvScene& scene);
  // Of the last that was shown.
  [[nodiscard]] bool is_skin(int geom) const {
    return geom >= background_ && geom < things_ && geom != background_ + sleeve_at_;
  }
  [[nodiscard]] bool is_thing(int geom) const { return geom >= things_; }
  [[nodiscard]] int background() const { return background_; }  // geoms

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
