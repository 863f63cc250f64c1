// A damper beside a rendered object, active while the measured tip oscillates against the hand:
//
//   b dd/dt + F_object(d) = F,      b = margin (2/pi) tau k_seen
//
// b = (2/pi) k tau keeps the loop of a hand of stiffness k and a lag tau stable, however soft the object is
// [sources/hexapod 5]. k_seen is the stiffness that the oscillation shows: if the tip moves by itself, force
// and depth change in opposite directions, dF = -k dd; if the tip gives way to a push, they change in the
// same direction. docs/reference/model.md has the whole law.
#pragma once

#include "core/base/frames.h"
#include "core/shape/response/response.h"
#include "core/spec/rendering_rig.h"

namespace enc {

struct LoopModel;

// State of a contact.
struct Swing {
  // Depth of the tip, low-passed as the force is, m; unset: not begun.
  double depth = kUnset;
  double slow_force = 0.0, slow_depth = 0.0;  // N, m: slow part, subtracted as the user's own motion
  // J: mean of -dF dd, twice the energy oscillating in the hand.
  double exchanged = 0.0;
  double moved = 0.0;                                               // m^2: mean of dd^2
  [[nodiscard]] double move() const { return depth - slow_depth; }  // m
  double stiffness = 0.0;                                           // N/m: k_seen
  double carried = 0.0;  // N: part of the pressing force that the object carries
};

// Separates an oscillation from slower motion of force and depth, and averages it.
struct SwingFilter {
  // Coefficients per tick: of the force low-pass, of the user's own motion, of the means.
  double low = 0.0, slow = 0.0, average = 0.0;
  // One tick of contact. The depth passes the same low-pass as the force, so that the two can be compared.
  void operator()(Swing& swing, double force, double depth) const noexcept;
};

class DampingLaw {
 public:
  // gain: of the force low-pass, per tick; acceleration: of commands along the normal, m/s^2.
  DampingLaw(const AdmittanceRig& rig, const LoopModel& loop, double gain, double acceleration, double dt);

  // Starts a contact with an object of this slope at its surface (N/m); force and depth as in observe().
  // Until measurements show otherwise, an object that is too soft for the loop is assumed to be pressed by
  // the hand that the rig expects.
  [[nodiscard]] Swing begin(double slope, double force, double depth) const noexcept;
  // One tick of contact: filtered force along -z of N, N, and depth of the tip there, m. Returns b, N s/m.
  double observe(Swing& swing, double force, double depth) const noexcept;
  // Part of the pressing force that the object carries after this tick; the damper carries the rest. `at` is
  // the object's state, `most` its deflection limit.
  [[nodiscard]] double carry(const Response& response, const ResponseState& at, double carried,
                             double pressed, double damping, double most) const noexcept;

  [[nodiscard]] double lag() const { return lag_; }  // s

 private:
  AdmittanceRig rig_;
  double hand_stiffness_, stable_slope_;  // N/m
  double lag_, acceleration_, dt_;
  SwingFilter filter_;
  double calm_;  // per tick
};

}  // namespace enc
