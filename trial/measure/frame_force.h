// What a new picture changes of what is felt along the normal. Beside the core runs a second one from the
// same state, which is not told of that picture: it goes on with the one before until the next, on the same
// readings of all else.
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

class FrameForce {
 public:
  // In place of step(): its results are those of step().
  void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out);

  // Of each picture of a finger that is near: the greatest change of the force along the normal until the
  // next, N. A tick counts in which either core is in contact.
  struct Change {
    bool touched = false;  // before it came
    double most = 0.0;     // unset: something was no number
  };
  [[nodiscard]] const std::vector<Change>& changes() const { return changes_; }

 private:
  Stamped<TrackedTool> newest_, untold_;  // what the core and what the second one goes on with
  State beside_;
  bool runs_ = false;  // the second one
  std::vector<Change> changes_;
};

// The greatest of those that came in a contact, or of those before one; unset where there is none, or where
// one of them is.
[[nodiscard]] double greatest_change(const std::vector<FrameForce::Change>& changes, bool touched);

}  // namespace enc::trial
