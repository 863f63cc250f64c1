// Whether an object that is pushed and held stands still. The loop with its limits is simulated: what pushes,
// sensor, filter, contact threshold, object, command limiter, dead time, servo. The linear bound of
// loop_model.h leaves the limits of speed and acceleration out: the wider a swing, the more they lag, so a
// loop that is stable for small swings can keep up a large one (docs/notes/stiffness.md compares it with the
// twin).
#pragma once

#include <optional>

#include "core/control/task/render/damping.h"
#include "core/machine/loop_model.h"
#include "core/shape/response/response.h"

namespace enc {

struct RigSpec;

// A push of the hand that the rig expects, along the normal: in along a minimum-jerk ramp, then held. A quick
// push swings where a slow one does not: commands lag at the machine's acceleration.
class Steadiness {
 public:
  // m, peak to peak: what swings less stands still. Assumed: 0.3 mm are felt, but no motion of their own.
  static constexpr double kStill = 0.3e-3;
  // Who pushes softly sways by the little that the contact threshold is.
  [[nodiscard]] double still() const;

  static constexpr double kSlow = 2.0, kQuick = 0.5;  // s: ramps; a person seldom presses quicker (assumed)

  explicit Steadiness(const RigSpec& rig);

  // m, peak to peak, of the tip in the last 3 s of a hold of 6 s. `depth`: that the hand wants, m; `limit`:
  // of the object's deflection, m; `ramp`: s. `share`: of the force that it pushes back with.
  [[nodiscard]] double swing(const Response& object, double depth, double limit, double ramp,
                             double share = 1.0) const;
  // The depth at which it swings most, of a few up to the limit; 0: it stands still at each.
  struct Worst {
    double depth = 0.0, swing = 0.0;  // m
  };
  [[nodiscard]] Worst worst(const Response& object, double limit, double ramp, double share = 1.0) const;
  // How much softer an object that stands still may be and does: the least share of its force, down to half.
  static constexpr double kLeastShare = 0.5;
  [[nodiscard]] double least_share(const Response& object, double limit, double ramp) const;
  // N/m: what is softer pushes back with less than a contact is, `depth` m deep.
  [[nodiscard]] double least_felt(double depth) const { return contact_ / depth; }
  // N/m, no less than that: from this stiffness on a spring stands still, pushed until it is up to `depth`
  // deep or pushes back with `force`, m and N.
  [[nodiscard]] double softest(double depth, double force, double ramp) const;

 private:
  // At each of a few depths up to `deepest`.
  [[nodiscard]] bool stands(const Response& object, double deepest, double limit, double ramp,
                            double share = 1.0) const;

  LoopModel loop_;
  double acceleration_, speed_;  // of commands along the normal, and of the machine's tip, m/s^2 and m/s
  double filter_gain_, dt_;      // per tick; s
  double threshold_, contact_;   // N
  std::optional<DampingLaw> law_;
};

}  // namespace enc
