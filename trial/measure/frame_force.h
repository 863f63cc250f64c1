// Effect of a disturbance on the force along the surface's normal: of a new picture, or of jitter.
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

// Effect of a new picture. A second core runs beside the first one from the
// same state but without that picture: until the next picture it continues with the previous one, on
// otherwise equal readings.
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
  Measurement<TrackedTool> newest_, untold_;  // newest pose of the core, and of the second core
  State beside_;
  bool runs_ = false;  // the second core runs
  std::vector<Change> changes_;
};

// Largest change among the pictures during a contact, or among those before one; unset if there is no such
// picture, or one of them is unset.
[[nodiscard]] double greatest_change(const std::vector<FrameForce::Change>& changes, bool touched);

// Force in each tick of a run, N; unset without a contact. felt_apart() compares two runs of a scene.
class FeltWay {
 public:
  void see(const Glance& glance) {
    felt_.push_back(glance.out.mode == Mode::contact ? glance.out.force.xyz[2] : kUnset);
  }
  [[nodiscard]] const std::vector<double>& felt() const { return felt_; }

 private:
  std::vector<double> felt_;
};

struct ForceDifference {
  std::size_t ticks = 0;  // ticks in which both were in contact
  // Largest difference in one tick, N. It includes the encoders' steps, which a contact 1 ms later has in
  // other ticks.
  double tick = 0.0;
  // Largest difference of the means over a frame in which both were in contact throughout, N.
  double frame = 0.0;
};
// `frame`: ticks in a frame.
[[nodiscard]] ForceDifference felt_apart(const FeltWay& one, const FeltWay& other, std::size_t frame);

}  // namespace enc::trial
