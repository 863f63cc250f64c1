// Admittance rendering: the force on the tip moves the tip as the object gives way under it [VHMR 3.3, 3.4].
#pragma once

#include <optional>

#include "core/base/sample.h"
#include "core/control/safety/passivity/passivity.h"
#include "core/control/stages/common_state.h"
#include "core/control/stages/displacement.h"
#include "core/control/task/admittance/damping.h"
#include "core/shape/response/response.h"
#include "core/spec/rendering_rig.h"

namespace enc {

struct Outputs;

// State of the passivity controller (admittance_task.cpp); unused without one.
struct RenderedEnergy {
  Passivity energy;  // energy of the present contact
  // N, along the normal, and tip position: both at the last tick.
  double pressed = 0.0;
  Point<'W'> tip;
};

struct AdmittanceState : CommandState {
  Contact contact;
  ResponseState response;  // the object's response since the first touch
  Swing swing;
  RenderedEnergy spent;
  Vec<'N'> displacement = Vec<'N'>::zero();
  Measurement<DentSample> dent;
  bool outside_dent = false;  // the tip is outside its deformed surface
};

namespace stages {
struct AdmittanceContext : ManipulatorContext {
  using ManipulatorContext::ManipulatorContext;
  // check_tip: surface point nearest to the tip's centre, in O of state.object.
  SurfacePoint at_tip;
};
}  // namespace stages

struct AdmittanceTask : DisplacementTask {
  using Memory = AdmittanceState;
  using Context = stages::AdmittanceContext;
  std::optional<DampingLaw> damping;  // set if the rig asks for a damper
  PassivityForm passivity = PassivityForm::none;
  double hand_stiffness = 0.0;  // N/m, stiffness of the rig's operator model
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
void fields(F& f, RenderedEnergy& s) {
  if (!s.energy.on) return;
  fields(f, s.energy);
  f("passivity_pressed", s.pressed);
  fields(f, "passivity_tip_W", s.tip);
}
template <class F>
void fields(F& f, AdmittanceState& r) {
  fields(f, static_cast<CommandState&>(r));
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
void touch(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
           AdmittanceState& now) noexcept;
void act(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
         AdmittanceState& now) noexcept;
void guard(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
           AdmittanceState& now) noexcept;
void report(const AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
            const AdmittanceState& now, Outputs& out) noexcept;

void rest(AdmittanceState& now) noexcept;  // resets the object to its unloaded state

// The stages of act().
void check_tip(AdmittanceContext& context, CommonState& state,
               AdmittanceState& now) noexcept;  // Is the tip inside the object and the shown surface?
void mode(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
          AdmittanceState& now) noexcept;  // away, follow, contact, restore
void model(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
           AdmittanceState& now) noexcept;  // force in, displacement out
// Computes the commanded tip position.
void target(AdmittanceContext& context, CommonState& state, const AdmittanceState& now) noexcept;
// Passivity controller: weigh() updates the energy balance; spare() limits the outward command to the energy
// left.
void weigh(const AdmittanceContext& context, const AdmittanceTask& task, const CommonState& state,
           AdmittanceState& now) noexcept;
void spare(AdmittanceContext& context, const AdmittanceTask& task, const CommonState& state,
           AdmittanceState& now) noexcept;
}  // namespace stages

}  // namespace enc
