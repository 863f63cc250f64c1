// A run at the moment of a picture. For a window, which draws on another thread, all that changes from tick
// to tick refers to copies.
#pragma once

#include "core/control/step.h"
#include "core/machine/hexapod.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "sim/truth/truth.h"
#include "trial/trial.h"

namespace enc::app {

struct Moment {
  const models::Setup& setup;
  const Scene& scene;
  const mjModel* model;
  const mjData* data;      // poses of all geoms
  const Hexapod* machine;  // null: the scene has an arm
  bool pushed;             // a pusher acts instead of a hand
  Pose<'W', 'R'> X_WR;
  Pose<'R', 'H'> platform;  // true pose of the hexapod's platform
  Quat q_WT;                // true orientation of the held tool
  const sim::Truth& truth;
  const State& state;
  const Outputs& out;
  const Tick& now;
};

// A picture of a scene with a camera needs no images. Adds a note.
void leave_out_vision(models::Setup& setup);
// Valid for a trial with a twin, after a tick.
[[nodiscard]] Moment moment_of(trial::Trial& trial);

[[nodiscard]] inline bool touching(const Moment& m) {
  return m.truth.touching && m.truth.contact_force.norm() > 0.01;
}

}  // namespace enc::app
