// A machine that carries a clamped tool from pose to pose, stands still at each, and tells what its force
// sensor and the tracker say there: in the twin or over real devices.
#pragma once

#include <cstddef>
#include <cstdint>

#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::trial {

// Means over the time in which it stood.
struct CarriedStand {
  double time = kUnset;      // s of experiment, of the middle
  Pose<'W', 'H'> X_WH;       // by the machine's own encoders
  Wrench wrench;             // raw
  std::size_t readings = 0;  // of the force sensor; 0: there is none
  Pose<'C', 'T'> X_CT;
  std::size_t packets = 0;  // in which the tracker saw the clamped tool
};

// Whether all of the way on which go() takes it is within reach.
[[nodiscard]] bool way_in_reach(const Reach& reach, const Pose<'W', 'R'>& X_WR, const Pose<'W', 'H'>& from,
                                const Pose<'W', 'H'>& to);

// The run was told to end: all that moves was stopped.
struct CarryingEnded {};

class CarriedTool {
 public:
  // `setup`: of a scene that clamps a tool. Nothing of what it renders is built: the tool is carried, watched
  // and weighed. Of the options: seed, drivers, armed, lockstep, pace, stop. Throws Error for all that is
  // refused before anything moves.
  CarriedTool(models::Setup setup, TrialOptions options);
  CarriedTool(const CarriedTool&) = delete;
  CarriedTool& operator=(const CarriedTool&) = delete;

  // The first one waits until the jaws hold the tool, and begins where the machine stands. Throws Error (kind
  // device): no way, nothing held, no rest, a hold, a link that is lost; CarryingEnded.
  void go(const Pose<'W', 'H'>& to);
  [[nodiscard]] CarriedStand stand();  // rests and measures where it is

  [[nodiscard]] const Trial& trial() const { return trial_; }
  [[nodiscard]] double now() const { return now_; }  // s of experiment

 private:
  TrialOptions with_law(TrialOptions options);
  void tick();
  void watch();  // throws where it does not do what it should
  void begin();
  void rest();
  [[nodiscard]] bool resting() const;

  Pose<'W', 'H'> wanted_;  // of the next tick; unset: it waits
  Vec<'F'> first_force_;   // N, raw, where it began; unset: not yet
  bool out_of_reach_ = false;
  double turned_off_ = 0.0;        // s that it has been turned otherwise than it was sent
  double now_ = 0.0, held_ = 0.0;  // s; in a hold
  Trial trial_;
};

}  // namespace enc::trial
