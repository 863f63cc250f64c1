// Passivity observer and controller of the energy that a law gives out along one direction, for one contact
// [Hannaford and Ryu 2002]. Outwards is positive: a law that pushes outwards gives out energy while the tip
// moves outwards.
//
//   left <- min(left - f_{n-1} (x_n - x_{n-1}), stored_n)
//   f_n  =  the largest part of the law's push that keeps  f (u + g f) <= left,   g = T^2 / (2 m)
//
// Observer: a force held over a period does exactly the work f_{n-1} (x_n - x_{n-1}). So the observer needs
// no model and sees everything inside the law (filter, rates, late readings). The law may give out the energy
// that was put in, but never more than its spring holds now. Energy that its dampers took does not count, so
// it cannot hide a later output (reference energy following [Ryu et al. 2005]).
//
// Controller: it looks one period ahead instead of correcting afterwards. It predicts x_{n+1} - x_n as u + g
// f; u is the free motion of the mass m after it moved by x_n - x_{n-1} under f_{n-1}. So it never divides by
// a low velocity: at rest the bound is sqrt(left / g). It only reduces a push and never reverses it: after a
// deficit the push is zero until as much energy was put in.
#pragma once

#include <string_view>

namespace enc {

// Tolerated energy deficit, J. Encoders cannot see a smaller one, and a user would feel a wall that stops
// pushing because of it.
constexpr double kForgiven = 0.03e-3;

struct Passivity {
  bool on = false;
  double left = 0.0;                 // J, may still be given out; negative: deficit
  double stored = 0.0;               // J, energy in the law's spring
  double moved = 0.0;                // m, outward motion in the last period
  double slack = 0.0;                // m: outward distance of the reading from where it turned
  double way = -1.0;                 // sign of the last motion
  double depth = 0.0, spring = 0.0;  // m, N: at the last tick
  double pushed = 0.0;               // N, outward push since the last tick
  double taken = 0.0;                // N, reduction of the law's push
  // Totals of this contact; `given` counts since the tip was outside.
  double given = 0.0;       // J: work of the actual push; positive: net energy out
  double dissipated = 0.0;  // J: extra energy that the unreduced law would have given
  double most = 0.0;        // N, largest value of `taken`
};

// Observation of one tick.
struct PassivityTick {
  double moved = 0.0;   // m, outward motion since the last tick
  double depth = 0.0;   // m, depth in the law's spring
  double spring = 0.0;  // N, outward push of the spring without motion
};
// Starts a contact. `left`, J: the energy put in before, counted up to what the spring holds; 0 for a wall
// that was not in contact yet; negative: a deficit.
void begin(Passivity& now, const PassivityTick& tick, double left) noexcept;
// Replaces the spring from now on, for example when the normal jumps; the change gives no energy.
void renew(Passivity& now, const PassivityTick& tick) noexcept;
// Ends the period in which `pushed` was held; readings step by `count`, m.
void observe(Passivity& now, const PassivityTick& tick, double count) noexcept;
// The part of the wanted push that is allowed, N, before other limits; `per_newton` is g, `count` as above.
[[nodiscard]] double passive(const Passivity& now, double wanted, double per_newton, double count) noexcept;
// Largest outward distance to which a machine that holds its path may be commanded, m. The hand pushes with
// `push` (N), and its push grows along the path by `stiffness` (N/m):
//   push s + stiffness s^2 / 2 <= left + forgiven
[[nodiscard]] double way_left(const Passivity& now, double forgiven, double push, double stiffness) noexcept;
// Stores the push that is held from now on, and the push that the law asked for.
void hold(Passivity& now, double pushed, double wanted) noexcept;

// A controller that is off adds no field, so a scene without it keeps its hash.
template <class F>
void fields(F& f, Passivity& p) {
  if (!p.on) return;
  f("passivity_left", p.left);
  f("passivity_stored", p.stored);
  f("passivity_moved", p.moved);
  f("passivity_slack", p.slack);
  f("passivity_way", p.way);
  f("passivity_depth", p.depth);
  f("passivity_spring", p.spring);
  f("passivity_pushed", p.pushed);
  f("passivity_taken", p.taken);
  f("passivity_given", p.given);
  f("passivity_dissipated", p.dissipated);
  f("passivity_most", p.most);
}

}  // namespace enc
