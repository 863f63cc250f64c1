// A damper beside a rendered object while the tip is seen to swing against what pushes on it:
//
//   b dd/dt + F_object(d) = F,      b = margin (2/pi) tau k_seen
//
// b = (2/pi) k tau keeps the loop of a pusher of stiffness k and a lag tau stable, however soft the object
// is [sources/hexapod 5]. k_seen is what swinging shows: where the tip moves by itself, force and depth
// change in opposite ways, dF = -k dd; where it gives in to a push they change alike. docs/reference/model.md
// has the whole law.
#pragma once

#include "core/base/frames.h"
#include "core/shape/response/response.h"
#include "core/spec/admittance_rig.h"

namespace enc {

struct LoopModel;

// What is remembered of a contact.
struct Swing {
  double depth = kUnset;                      // m, of the tip, low-passed as the force is; unset: not begun
  double slow_force = 0.0, slow_depth = 0.0;  // N, m: what is taken out as the user's own
  double exchanged = 0.0;                     // J: mean of -dF dd, twice what swings in the pusher
  double moved = 0.0;                         // m^2: mean of dd^2
  [[nodiscard]] double move() const { return depth - slow_depth; }  // m
  double stiffness = 0.0;                                           // N/m: k_seen
  double carried = 0.0;  // N: of the pressing force, what the object carries
};

// How a swing is seen: force and depth, freed of what is slower than a swing, averaged.
struct SwingFilter {
  double low = 0.0, slow = 0.0,
         average = 0.0;  // per tick: of the force, of what is the user's own, of the means
  // A tick of contact. The depth is made as late as the force is, so that the two can be compared.
  void operator()(Swing& swing, double force, double depth) const noexcept;
};

class DampingLaw {
 public:
  // gain: of the force low-pass, per tick; acceleration: of commands along the normal, m/s^2.
  DampingLaw(const AdmittanceRig& rig, const LoopModel& loop, double gain, double acceleration, double dt);

  // Begins a contact with an object of this slope at its surface, N/m, at a force and depth as below. Until
  // something else is seen, what pushes on an object that is too soft for the loop is taken for the hand that
  // the rig expects.
  [[nodiscard]] Swing begin(double slope, double force, double depth) const noexcept;
  // A tick of contact: filtered force along -z of N, N, and depth of the tip there, m. Gives b, N s/m.
  double observe(Swing& swing, double force, double depth) const noexcept;
  // How much of the pressing force the object carries after this tick; the damper carries the rest. `at` is
  // where the object is, `most` its deflection limit.
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
