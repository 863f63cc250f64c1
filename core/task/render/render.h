// Render by displacement: the force on the tip moves the tip as the object gives way under it
// [VHMR 3.3, 3.4].
#pragma once

#include <optional>

#include "core/machine/damping.h"
#include "core/response/response.h"
#include "core/sample.h"
#include "core/task/contact.h"
#include "core/task/displacing.h"

namespace enc {

struct Outputs;

struct Rendering : Commanded {
  Contact contact;
  ResponseState response;  // how the object answers from the first touch on
  Swing swing;
  Vec<'N'> displacement = Vec<'N'>::zero();
  Stamped<DentSample> dent;
  bool outside_dent = false;  // the tip is outside its deformed surface
};

struct Render : Displacing {
  using Memory = Rendering;
  std::optional<DampingLaw> damping;  // where the rig wants the object damped
};

template <class F>
void fields(F& f, Swing& s) {
  f("swing_depth", s.depth);
  f("swing_slow_force", s.slow_force);
  f("swing_slow_depth", s.slow_depth);
  f("swing_exchanged", s.exchanged);
  f("swing_moved", s.moved);
  f("swing_stiffness", s.stiffness);
  f("carried", s.carried);
}
template <class F>
void fields(F& f, Rendering& r) {
  fields(f, static_cast<Commanded&>(r));
  fields(f, r.contact);
  f("response_deflection", r.response.deflection);
  f("response_alpha", r.response.alpha);
  fields(f, "response_stop", r.response.stop);
  fields(f, r.swing);
  fields(f, "displacement_N", r.displacement);
  fields(f, r.dent);
  f("outside_dent", r.outside_dent);
}

namespace stages {
void touch(Walk& walk, const Render& task, State& state, Rendering& now) noexcept;
void act(Walk& walk, const Render& task, State& state, Rendering& now) noexcept;
void guard(Walk& walk, const Render& task, State& state, Rendering& now) noexcept;
void report(const Walk& walk, const Render& task, State& state, const Rendering& now, Outputs& out) noexcept;

void rest(Rendering& now) noexcept;  // the object as it is when nothing presses it

// The stages that act() is made of.
void check_tip(Walk& walk, State& state,
               Rendering& now) noexcept;  // is it inside the object and the seen surface?
void mode(Walk& walk, const Render& task, State& state,
          Rendering& now) noexcept;  // away, follow, contact, restore
void model(Walk& walk, const Render& task, State& state,
           Rendering& now) noexcept;                                   // force in, displacement out
void target(Walk& walk, State& state, const Rendering& now) noexcept;  // where the tip should be
}  // namespace stages

}  // namespace enc
