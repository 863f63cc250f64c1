// Render by displacement: the force on the tip moves the tip as the object gives way under it
// [VHMR 3.3, 3.4].
#pragma once

#include <optional>

#include "core/base/sample.h"
#include "core/control/safety/passivity/passivity.h"
#include "core/control/stages/contact.h"
#include "core/control/stages/displacing.h"
#include "core/control/task/render/damping.h"
#include "core/shape/response/response.h"
#include "core/spec/passivity_form.h"

namespace enc {

struct Outputs;

// What the passivity controller remembers (spare.cpp); nothing where nothing is controlled.
struct Spent {
  Passivity energy;      // of the present contact
  double pressed = 0.0;  // N, along the normal, at the last tick; and where the tip was
  Point<'W'> tip;
};

struct Rendering : Commanded {
  Contact contact;
  ResponseState response;  // how the object answers from the first touch on
  Swing swing;
  Spent spent;
  Vec<'N'> displacement = Vec<'N'>::zero();
  Stamped<DentSample> dent;
  bool outside_dent = false;  // the tip is outside its deformed surface
};

struct Render : Displacing {
  using Memory = Rendering;
  std::optional<DampingLaw> damping;  // where the rig wants the object damped
  PassivityForm passivity = PassivityForm::none;
  double hand_stiffness = 0.0;  // N/m, that the rig expects
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
void fields(F& f, Spent& s) {
  if (!s.energy.on) return;
  fields(f, s.energy);
  f("passivity_pressed", s.pressed);
  fields(f, "passivity_tip_W", s.tip);
}
template <class F>
void fields(F& f, Rendering& r) {
  fields(f, static_cast<Commanded&>(r));
  fields(f, r.contact);
  f("response_deflection", r.response.deflection);
  f("response_alpha", r.response.alpha);
  fields(f, "response_stop", r.response.stop);
  fields(f, r.swing);
  fields(f, r.spent);
  fields(f, "displacement_N", r.displacement);
  fields(f, r.dent);
  f("outside_dent", r.outside_dent);
}

namespace stages {
void touch(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept;
void act(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept;
void guard(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept;
void report(const Walk& walk, const Render& task, CommonState& state, const Rendering& now,
            Outputs& out) noexcept;

void rest(Rendering& now) noexcept;  // the object as it is when nothing presses it

// The stages that act() is made of.
void check_tip(Walk& walk, CommonState& state,
               Rendering& now) noexcept;  // is it inside the object and the seen surface?
void mode(Walk& walk, const Render& task, CommonState& state,
          Rendering& now) noexcept;  // away, follow, contact, restore
void model(Walk& walk, const Render& task, CommonState& state,
           Rendering& now) noexcept;                                         // force in, displacement out
void target(Walk& walk, CommonState& state, const Rendering& now) noexcept;  // where the tip should be
// Of a controller of energy: what it has given out by now, and no farther out than what is left carries it.
void weigh(const Walk& walk, const Render& task, const CommonState& state, Rendering& now) noexcept;
void spare(Walk& walk, const Render& task, const CommonState& state, Rendering& now) noexcept;
}  // namespace stages

}  // namespace enc
