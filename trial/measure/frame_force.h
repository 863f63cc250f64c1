// Effect of a new picture on the force along the normal. A second core runs beside the first one from the
// same state but without that picture: until the next picture it continues with the previous one, on
// otherwise equal readings.
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

class FrameForce {
 public:
  // Call this in place of step(); it returns the results of step().
  void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out);

  // Effect of each picture of a near finger: the largest change of the normal force until the next picture,
  // N. A tick counts if either core is in contact.
  struct Change {
    bool touched = false;  // a contact before the picture came
    double most = 0.0;     // unset: a value was not finite
  };
  [[nodiscard]] const std::vector<Change>& changes() const { return changes_; }

 private:
  Stamped<TrackedTool> newest_, untold_;  // newest pose of the core, and of the second core
  State beside_;
  bool runs_ = false;  // the second core runs
  std::vector<Change> changes_;
};

// Largest change among the pictures during a contact, or among those before one; unset if there is no such
// picture, or one of them is unset.
[[nodiscard]] double greatest_change(const std::vector<FrameForce::Change>& changes, bool touched);

}  // namespace enc::trial
