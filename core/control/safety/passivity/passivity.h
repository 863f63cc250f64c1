// Observer and controller of the energy that a law gives out along one way, of one contact [Hannaford and Ryu
// 2002]. Outwards is positive: pushed outwards while it moves outwards, the law gives out.
//
//   left <- min(left - f_{n-1} (x_n - x_{n-1}), stored_n)
//   f_n  =  of the law's push as much, from none to all, as keeps  f (u + g f) <= left,   g = T^2 / (2 m)
//
// A force that is held over a period does exactly f_{n-1} (x_n - x_{n-1}): the observer needs no model, and
// whatever is inside the law (filter, rates, late readings) is seen. What may be given out is what was put
// in; and never more than the law's spring holds now: what its dampers took is gone, and cannot hide what is
// given out later (reference energy following [Ryu et al. 2005]).
//
// The controller looks ahead a period instead of mending what is past: x_{n+1} - x_n is believed to be u + g
// f, u being what the mass m does by itself after it has moved by x_n - x_{n-1} under f_{n-1}. So nothing is
// divided by a low velocity: at rest the bound is sqrt(left / g). It only lessens a push, and never turns it
// round: where more was given out than there was, nothing more is, until as much was put in.
#pragma once

#include <string_view>

namespace enc {

// J: less is owed by what no encoder sees, and a wall that stops pushing for it would be felt.
constexpr double kForgiven = 0.03e-3;

struct Passivity {
  bool on = false;
  double left = 0.0;                 // J, that may be given out; below 0: more was
  double stored = 0.0;               // J, that the law's spring holds
  double moved = 0.0;                // m, outwards, in the last period
  double slack = 0.0;                // m: a reading is so far outwards of where it turned
  double way = -1.0;                 // which way it last moved
  double depth = 0.0, spring = 0.0;  // m, N: at the last tick
  double pushed = 0.0;               // N, outwards, since the last tick
  double taken = 0.0;                // N: the law asked for so much more
  // Of this contact; `given` since the tip was outside.
  double given = 0.0;       // J: work of what was pushed; above 0: more out than in
  double dissipated = 0.0;  // J: what the law would have given out more
  double most = 0.0;        // N, the largest of `taken`
};

// A tick.
struct Yielded {
  double moved = 0.0;   // m, outwards, since the last tick
  double depth = 0.0;   // m, of the law's spring
  double spring = 0.0;  // N, that it pushes outwards with where nothing moves
};
// A contact begins. `left`, J: what was put in before, of which no more counts than the spring holds; 0 of a
// wall that was not felt yet; below 0: what is owed.
void begin(Passivity& now, const Yielded& tick, double left) noexcept;
// Its spring is another one from now on, as where the normal jumps: nothing is given for that.
void renew(Passivity& now, const Yielded& tick) noexcept;
// The period is over in which `pushed` was held; readings step by `count`, m.
void observe(Passivity& now, const Yielded& tick, double count) noexcept;
// N: what of the wanted push is given, whatever the limits; `per_newton` is g, `count` as above.
[[nodiscard]] double passive(const Passivity& now, double wanted, double per_newton, double count) noexcept;
// m: how far outwards of where it is a machine may be sent that keeps to its way. It is pushed with `push`,
// N, and on the way that grows by `stiffness`, N/m:
//
//   push s + stiffness s^2 / 2 <= left + forgiven
[[nodiscard]] double way_left(const Passivity& now, double forgiven, double push, double stiffness) noexcept;
// What is held from now on, and what the law asked for.
void hold(Passivity& now, double pushed, double wanted) noexcept;

// Nothing of one that is off: a scene without it has the hash that it had.
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
