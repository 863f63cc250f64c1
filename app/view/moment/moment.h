// A run at the moment of a picture. A window draws on another thread, so all data that change from tick to
// tick are copies.
#pragma once

#include <vector>

#include "core/control/step.h"
#include "core/machine/hexapod.h"
#include "core/vision/augment/augmented_view.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "sim/truth/truth.h"
#include "trial/trial.h"

namespace enc::app {

struct MachineLook;

struct Moment {
  const models::Setup& setup;
  const Scene& scene;
  const mjModel* model;
  const mjData* data;       // poses of all geoms
  const MachineLook& look;  // drawing of the machine (depict.h)
  const Hexapod* machine;   // null: the scene has an arm
  bool pushed;              // a pusher acts instead of a hand
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

[[nodiscard]] inline bool touching(const sim::Truth& truth) {
  return truth.touching && truth.contact_force.norm() > 0.01;
}

// A moment of a run by value, which the window shows now or later.
struct RunSnapshot {
  sim::Truth truth;
  State state;
  Outputs out;
  Tick now;
  Pose<'R', 'H'> platform;
  Quat q_WT = Quat::Identity();
  bool halted = false;     // halted by hand
  bool simulated = true;   // every device is simulated: the truth has all touches
  std::vector<double> at;  // all geoms and sites of the model, in the order of mjData
};

// Takes the present moment of a trial with a twin. `simulated`: as in Still. If false, tool and tip are those
// reported by the devices, not the twin's.
void take_still(trial::Trial& trial, const trial::Glance& glance, bool simulated, RunSnapshot& to);
// The moment for a picture; `data`, of the trial's model, receives the poses.
[[nodiscard]] Moment moment_of(trial::Trial& trial, const RunSnapshot& still, mjData* data);

// Inputs of the augmented view (core/vision/augment) for a run, as the core has them.
[[nodiscard]] AugmentedSpec believed_spec(const models::Setup& setup, const Scene& scene);

// The moment after the tick that received the image.
class BelievedMoment {
 public:
  [[nodiscard]] AugmentedMoment of(trial::Trial& trial);

 private:
  Quat q_WN_ = Quat::Identity();  // orientation of the last near surface
};

}  // namespace enc::app
