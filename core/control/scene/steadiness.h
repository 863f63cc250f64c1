// Checks whether an object that is pressed and held stays stable, by a simulation of the loop with its
// limits: hand, sensor, filter, contact threshold, object, command limiter, dead time, servo. The linear
// bound of loop_model.h ignores the limits of speed and acceleration. These lag more in a wider oscillation.
// So a loop that is stable for small oscillations can sustain a large one (docs/notes/stiffness.md compares
// it with the twin).
#pragma once

#include <optional>

#include "core/control/task/admittance/damping.h"
#include "core/machine/loop_model.h"
#include "core/shape/response/response.h"

namespace enc {

struct RigSpec;

// A push of the rig's operator model along the normal: a minimum-jerk ramp, then a hold. A quick push can
// start an oscillation that a slow one does not start, because commands lag at the machine's acceleration.
class Steadiness {
 public:
  // m, peak to peak: a smaller oscillation counts as stable. Assumed: a person feels 0.3 mm, but not as a
  // motion of its own.
  static constexpr double kStill = 0.3e-3;
  // The stability limit, m. A soft hand sways by as much as the contact threshold lets it, so its limit is
  // higher.
  [[nodiscard]] double still() const;

  static constexpr double kSlow = 2.0, kQuick = 0.5;  // s: ramps; few people press quicker (assumed)

  explicit Steadiness(const RigSpec& rig);

  // Oscillation of the tip in the last 3 s of a hold of 6 s, m, peak to peak. `depth`: requested by the hand,
  // m; `limit`: the object's deflection limit, m; `ramp`: s; `share`: factor on the object's force.
  [[nodiscard]] double swing(const Response& object, double depth, double limit, double ramp,
                             double share = 1.0) const;
  // The depth with the largest oscillation, of a few up to the limit; 0: stable at each depth.
  struct WorstDepth {
    double depth = 0.0, swing = 0.0;  // m
  };
  [[nodiscard]] WorstDepth worst(const Response& object, double limit, double ramp, double share = 1.0) const;
  // The least share of the object's force that is still stable, i.e. how much softer a stable object may be;
  // not below half.
  static constexpr double kLeastShare = 0.5;
  [[nodiscard]] double least_share(const Response& object, double limit, double ramp) const;
  // N/m: a softer object pushes back with less than the contact threshold, at `depth` m.
  [[nodiscard]] double least_felt(double depth) const { return contact_ / depth; }
  // Minimum stable stiffness of a spring, N/m, at least that of least_felt(). The spring is pushed up to
  // `depth` (m) or up to `force` (N), whichever comes first.
  [[nodiscard]] double softest(double depth, double force, double ramp) const;

 private:
  // True if stable at each of a few depths up to `deepest`.
  [[nodiscard]] bool stands(const Response& object, double deepest, double limit, double ramp,
                            double share = 1.0) const;

  LoopModel loop_;
  // Limits of commands along the normal and of the machine's tip, m/s^2 and m/s.
  double acceleration_, speed_;
  double filter_gain_, dt_;     // per tick; s
  double threshold_, contact_;  // N
  std::optional<DampingLaw> law_;
};

}  // namespace enc
