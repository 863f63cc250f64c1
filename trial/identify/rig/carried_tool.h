// A machine that carries a clamped tool from pose to pose, stands still at each, and reports the data of
// force sensor and tracker. It works in the twin or with real devices.
#pragma once

#include <cstddef>
#include <cstdint>

#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::trial {

// Means over the time in which it stood.
struct CarriedStand {
  double time = kUnset;      // s of experiment, middle of that time
  Pose<'W', 'H'> X_WH;       // measured by the machine's own encoders
  Wrench wrench;             // raw
  std::size_t readings = 0;  // number of the force sensor's readings; 0: no sensor
  Pose<'C', 'T'> X_CT;
  std::size_t packets = 0;  // packets in which the tracker saw the clamped tool
};

// True if the whole path of go() between two poses is within reach.
[[nodiscard]] bool way_in_reach(const Reach& reach, const Pose<'W', 'R'>& X_WR, const Pose<'W', 'H'>& from,
                                const Pose<'W', 'H'>& to);

// Thrown when the run was asked to end; every moving device has been stopped.
struct CarryingEnded {};

class CarriedTool {
 public:
  // `setup`: of a scene that clamps a tool. Its rendering is not built: the tool is carried, tracked and
  // weighed. Used options: seed, drivers, armed, lockstep, pace, stop. Throws Error for everything that is
  // refused before anything moves.
  CarriedTool(models::Setup setup, TrialOptions options);
  CarriedTool(const CarriedTool&) = delete;
  CarriedTool& operator=(const CarriedTool&) = delete;

  // The first call waits until the jaws hold the tool, and begins at the machine's present pose. Throws Error
  // (kind device): no path, no tool held, no rest, a hold, a lost link; or CarryingEnded.
  void go(const Pose<'W', 'H'>& to);
  [[nodiscard]] CarriedStand stand();  // rests, and measures at its present pose

  [[nodiscard]] const Trial& trial() const { return trial_; }
  [[nodiscard]] double now() const { return now_; }  // s of experiment

 private:
  TrialOptions with_law(TrialOptions options);
  void tick();
  void watch();  // throws if the machine misbehaves
  void begin();
  void rest();
  [[nodiscard]] bool resting() const;

  Pose<'W', 'H'> wanted_;  // pose for the next tick; unset: it waits
  Vec<'F'> first_force_;   // N, raw, at the begin; unset: not yet
  bool out_of_reach_ = false;
  double turned_off_ = 0.0;        // s with a rotation other than commanded
  double now_ = 0.0, held_ = 0.0;  // s of experiment; s in a hold
  Trial trial_;
};

}  // namespace enc::trial
