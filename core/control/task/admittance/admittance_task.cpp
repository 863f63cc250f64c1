#include "core/control/task/admittance/admittance_task.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/rotation.h"
#include "core/control/safety/inside.h"
#include "core/control/stages/guard.h"
#include "core/control/stages/report.h"
#include "core/shape/deformation/dent.h"

namespace enc::stages {

// ---- Checks that the tip is inside the object [VHMR 3.3], and inside the surface that the user sees [VHMR
// 3.5].

namespace {

// m: play and overshoot of a machine below this are no fault (assumed: no source).
constexpr double kPlay = 50e-6;
// m: no tip and no dent of a display is larger, and no object farther (assumed: well beyond a machine's
// reach).
constexpr double kWidestTip = 0.1, kLongestTip = 1.0, kDeepestDent = 0.1, kFarthestTip = 10.0;
// Accepted error of the tip axis's length (assumed: no source).
constexpr double kUnit = 1e-3;
// Share of the margin within which a tip outside the seen surface counts as inside again (assumed: no
// source).
constexpr double kWellInside = 0.7;

bool command_stays(const AdmittanceContext& context, CommonState& state, const CommandState& now) {
  Inside inside(context.scene, state.object, least_depth(context), Vec<'W'>::zero(), state.hints.command);
  const Brake brake = brake_of(context, now);
  const double here = inside.depth(brake.at);
  return here >= context.scene.tip_radius && inside.can_stop(brake, here, brake.velocity);
}

// `distance`: from the tip's outermost point to the undeformed surface, m.
void check_undeformed(AdmittanceContext& context, double distance, CommonState& state,
                      const CommandState& now) {
  // On its way in, the tip is rightly outside, and so is its command.
  if (!state.entered && distance <= -kSkin) state.entered = command_stays(context, state, now);
  if (state.entered && distance > kPlay) context.why |= kOutsideObject;
}

bool possible(const Tip<'O'>& tip) {
  return tip.centre.finite() && tip.centre.e().norm() < kFarthestTip && tip.radius >= 0.0 &&
         tip.radius < kWidestTip && tip.shape <= TipShape::edge && std::abs(tip.axis.norm() - 1.0) < kUnit &&
         tip.half_angle >= 0.0 && tip.half_angle < 0.5 * std::numbers::pi && tip.length >= 0.0 &&
         tip.length < kLongestTip;
}

bool possible(const AdmittanceContext& context, const Measurement<DentSample>& sample) {
  const DentSample& dent = sample.value;
  if (sample.t > context.tick.t + context.tick.dt) return false;
  if (dent.object == -1) return true;
  return dent.object >= 0 && dent.object < static_cast<int>(context.scene.objects.size()) &&
         possible(dent.tip) && dent.depth >= 0.0 && dent.depth < kDeepestDent;
}

// The seen surface is late: the tip may be outside it by the distance that tool and tip can have moved since
// [VHMR 3.5].
void check_dent(AdmittanceContext& context, const Object& object, const Point<'O'>& outer, double distance,
                CommonState& state, AdmittanceState& now) {
  if (context.in.dent.health == Health::fault ||
      (context.in.dent.health == Health::ok && !possible(context, context.in.dent))) {
    context.why |= kDentWrong;
    return;
  }
  if (context.in.dent.health == Health::ok &&
      (now.dent.health == Health::absent || context.in.dent.t > now.dent.t))
    now.dent = context.in.dent;
  const DisplayRig& rig = context.scene.display;
  // Before the first surface, the time counts from the start of the experiment.
  const double old = age(context.tick.t, now.dent.t);
  if (old > rig.overdue) {
    if (state.mode != Mode::away) context.why |= kDentOverdue;
    return;
  }
  if (now.dent.value.object != state.object) {
    now.outside_dent = false;
    return;
  }
  // A fused tip is drawn ahead by the lead: tool and tip may stop or turn in that time, too.
  const double unsure = old + (rig.tip == SeenTip::fused ? rig.lead : 0.0);
  // The margin shrinks with each new frame, so a tip outside counts as inside again only well within it.
  const double margin = (rig.margin + rig.margin_speed * unsure) * (now.outside_dent ? kWellInside : 1.0);
  // On its way in, the tip is rightly outside. A dent moves the surface by at most its depth; usually that
  // decides.
  const bool maybe = state.entered && distance + now.dent.value.depth > margin;
  now.outside_dent =
      maybe && dented_distance(object.surface, now.dent.value, outer, context.at_tip.feature) > margin;
  if (now.outside_dent) context.why |= kOutsideDent;
}

}  // namespace

void check_tip(AdmittanceContext& context, CommonState& state, AdmittanceState& now) noexcept {
  if (!context.X_WH.valid() || state.object < 0) return;
  const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
  const Point<'O'> centre = object.X_OW * context.X_WH.origin();
  ObjectHint& hint = state.hints.tip;
  context.at_tip = object.surface.nearest(centre, hint.object == state.object ? hint.feature : -1);
  hint = {state.object, context.at_tip.feature};
  // The point of the tip that is nearest to the outside of the object.
  const Point<'O'> outer = centre + context.scene.tip_radius * context.at_tip.normal;
  const double distance = object.surface.nearest(outer, context.at_tip.feature).distance;
  check_undeformed(context, distance, state, now);
  if (context.scene.has_display) check_dent(context, object, outer, distance, state, now);
}

// ---- Force in, displacement out [VHMR 3.4], and the tip position that follows from it.

namespace {

// Sideways displacement of the contact point, never more than the deflection limit.
Vec3 tangential_give(const Object& object, const Vec<'N'>& force, double limit) {
  if (object.tangential == TangentialMode::stick) return Vec3::Zero();
  Vec3 give(force.xyz[0] / object.tangential_stiffness, force.xyz[1] / object.tangential_stiffness, 0.0);
  const double size = give.norm();
  return size > limit ? Vec3(give * (limit / size)) : give;
}

// m: distance below a tool that is already inside at which the tip stops. The machine lags by some 2 mm
// behind a tool that moves at 30 mm/s.
constexpr double kBelow = 3e-3;

// Part of the pressing force that the object carries; the damper carries the rest.
double carried(const AdmittanceContext& context, const AdmittanceTask& task, const Object& object,
               AdmittanceState& now, double force, double pressed, double limit) {
  if (!task.damping) return pressed;
  const DampingLaw& law = *task.damping;
  Swing& swing = now.swing;
  const double depth =
      -(now.contact.X_WN.inverse() * context.X_WH.origin()).xyz[2] - context.scene.tip_radius;
  if (std::isnan(swing.depth)) {
    const double near = 1e-3 * limit;
    swing = law.begin(object.response.press(near) / near, force, depth);
  }
  const double damping = law.observe(swing, force, depth);
  swing.carried = law.carry(object.response, now.response, swing.carried, pressed, damping, limit);
  return swing.carried;
}

// Beside an edge the tip cannot be right under the tool. It waits at the nearest position with the whole tip
// inside.
Point<'W'> inside(const AdmittanceContext& context, CommonState& state, std::int32_t object, double margin,
                  const Point<'W'>& wanted) {
  return Inside(context.scene, object, margin, Vec<'W'>::zero(), state.hints.command).nearest_to(wanted);
}

// Straight under the surface point. Inside round and flat objects that is enough; in a mesh another side may
// be near.
Point<'W'> under_surface(const AdmittanceContext& context, CommonState& state, double margin) {
  const Point<'W'> under = context.surface_point - margin * context.normal;
  const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
  const bool mesh = std::holds_alternative<MeshSurface>(object.surface.shape());
  return mesh ? inside(context, state, state.object, margin, under) : under;
}

}  // namespace

void model(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
           AdmittanceState& now) noexcept {
  const Contact& contact = now.contact;
  if (state.mode != Mode::contact || now.contact.below) {
    rest(now);
    return;
  }
  if (!context.force.finite()) return;  // no zero yet: stay at the surface
  const Object& object = context.scene.objects[static_cast<std::size_t>(contact.object)];
  const Vec<'N'> force = contact.X_WN.inverse() * context.force;
  const double pressed = std::max(0.0, -force.xyz[2] - context.scene.force.threshold);
  const double limit = object.limit_at(state.contacts);
  const double deflection = object.response.deflection(
      now.response, carried(context, task, object, now, -force.xyz[2], pressed, limit), limit);
  if (deflection >= limit) context.why |= kAtLimit;
  // The limit keeps the object's request below this (scene.cpp); the target stays in place.
  if (pressed > context.scene.strength) context.why |= kOverload;
  const Vec3 sideways = tangential_give(object, force, limit);
  now.displacement = Vec<'N'>(sideways.x(), sideways.y(), -deflection);
}

void target(AdmittanceContext& context, CommonState& state, const AdmittanceState& now) noexcept {
  const double radius = context.scene.tip_radius;
  switch (state.mode) {
    case Mode::follow:
      context.target = under_surface(context, state, radius + context.scene.follow.inset);
      break;
    case Mode::contact:
    case Mode::restore: {
      const double below = now.contact.below ? kBelow + std::max(0.0, -context.gap) : 0.0;
      const Vec3 d = now.displacement.e() - below * Vec3::UnitZ();
      // Sideways motion along the tangent plane would lead out of a round object.
      context.target = inside(context, state, now.contact.object, radius + kSkin,
                              now.contact.X_WN * Point<'N'>(d.x(), d.y(), d.z() - radius - kSkin));
      break;
    }
    case Mode::away:
    case Mode::hold:
    case Mode::probe:
    case Mode::travel:
      context.target = context.scene.X_WR * now.command;
      break;
  }
}

// ---- Passivity controller of a machine that measures force and takes positions. It acts between the law and
// its limits, along the normal of the contact.
//
// If the hand pushes with p while the tip moves outwards by dx, the hand receives p dx, by the machine's own
// readings; no model is needed. The energy left is what the hand has put in, but never more than the object
// would hold at the tip's position (its press curve). It limits how far out the tip may be sent.
//
// Sending the tip out spends this energy: against the measured push, or against the first push of a hand that
// the tip meets, which grows as the hand comes on. So motion still under way (dead time, servo) is paid for
// before it is sent, and the limits leave room to stop.

namespace {

// m: a tip farther from the tool meets nothing. Covers the tracker's delay and error, and the tip's stopping
// distance.
constexpr double kNearHand = 3e-3;
constexpr double kMet = 0.8;    // N, first push of a hand that meets the tip. Chosen.
constexpr double kComes = 2.0;  // times the hand's stiffness: the hand moves as fast as the tip. Chosen.
// m, motion of the hand while the tip is being stopped (dead time, servo): 20 mm/s for 55 ms. Chosen.
constexpr double kComesOn = 1.1e-3;

// Outward motion along the normal since the last tick, and the depth and push of the object at the tip.
PassivityTick yielded(const AdmittanceContext& context, const AdmittanceState& now) {
  const Contact& contact = now.contact;
  const Object& object = context.scene.objects[static_cast<std::size_t>(contact.object)];
  const Vec<'W'> normal = contact.X_WN * Vec<'N'>(0, 0, 1);
  const double height = (contact.X_WN.inverse() * context.X_WH.origin()).xyz[2];
  const double depth = -(height + context.scene.tip_radius + kSkin);
  const double moved = now.spent.energy.on ? dot(context.X_WH.origin() - now.spent.tip, normal) : 0.0;
  return {moved, depth, depth > 0.0 ? object.response.press(std::min(depth, object.response.limit())) : 0.0};
}

// m, outwards: free way of the tip, because the tool is seen farther away.
double free_way(const AdmittanceContext& context, double depth, double push) {
  if (!context.tool_known || !context.tool_fresh || push >= context.scene.force.contact) return 0.0;
  return std::max(0.0, context.gap + depth - kNearHand);
}

// N, push of a hand, which cannot pull. If the force is unknown for a moment, the last push holds. If the tip
// can meet nothing, the force is the sensor's error.
double pressed(const AdmittanceContext& context, const AdmittanceState& now, double depth) {
  if (!context.force_unfiltered.finite()) return now.spent.pressed;
  const double push = -dot(context.force_unfiltered, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  return free_way(context, depth, push) > 0.0 ? 0.0 : std::max(0.0, push);
}

// True in a contact, and on the way back from it until the tip is at its waiting position.
bool engaged(const AdmittanceContext& context, const CommonState& state, const AdmittanceState& now) {
  if (state.mode == Mode::contact || state.mode == Mode::restore) return true;
  return now.spent.energy.on && state.mode == Mode::follow &&
         now.spent.energy.depth > context.scene.follow.inset;
}

}  // namespace

void weigh(const AdmittanceContext& context, const AdmittanceTask&, const CommonState& state,
           AdmittanceState& now) noexcept {
  RenderedEnergy& spent = now.spent;
  if (!spent.energy.on) return;
  if (!engaged(context, state, now)) {
    spent = RenderedEnergy{};
    return;
  }
  if (!context.X_WH.valid()) return;
  const PassivityTick tick = yielded(context, now);
  const double push = pressed(context, now, tick.depth);
  const auto [least, most] = std::minmax(spent.pressed, push);
  // The hand's force changes linearly between two ticks: the trapezoid rule. The energy is unknown if a touch
  // began or ended within a tick: the hand may have received all of the energy and put in none.
  const bool whole = least >= context.scene.force.contact;
  spent.energy.pushed = whole ? 0.5 * (least + most) : tick.moved > 0.0 ? most : least;
  // The sensor's error favours neither side: inward motion credits the hand with less, outward motion charges
  // it with more.
  if (whole) spent.energy.pushed += std::copysign(context.scene.force.threshold, tick.moved);
  observe(spent.energy, tick, 0.0);
  // A deficit ends with its contact: the tip does not wait once no hand pushes it.
  if (state.mode == Mode::follow && push < context.scene.force.contact)
    spent.energy.left = std::max(0.0, spent.energy.left);
  spent.pressed = push;
  spent.tip = context.X_WH.origin();
}

void spare(AdmittanceContext& context, const AdmittanceTask& task, const CommonState& state,
           AdmittanceState& now) noexcept {
  if (task.passivity == PassivityForm::none || !engaged(context, state, now) || !context.X_WH.valid()) return;
  RenderedEnergy& spent = now.spent;
  if (!spent.energy.on) {
    // The hand has put in no energy yet, and meeting an object deep inside gives no credit.
    const PassivityTick tick = yielded(context, now);
    begin(spent.energy, tick, 0.0);
    spent.pressed = pressed(context, now, tick.depth);
    spent.tip = context.X_WH.origin();
  }
  const Vec<'W'> normal = now.contact.X_WN * Vec<'N'>(0, 0, 1);
  const double wanted = dot(context.target - context.X_WH.origin(), normal);
  // Noise alone causes a small deficit, too, and no hand can pay it.
  const bool pushed = spent.pressed >= context.scene.force.contact;
  const double comes_on = state.mode == Mode::follow ? 0.0 : kComesOn * task.hand_stiffness;
  const double push = std::max(kMet, spent.pressed) + comes_on;
  const double most = free_way(context, spent.energy.depth, spent.pressed) +
                      way_left(spent.energy, pushed ? 0.0 : kForgiven, push, kComes * task.hand_stiffness);
  if (!(wanted > most)) return;
  context.why |= kPassive;
  if (!pushed || spent.energy.left >= 0.0) {
    context.target = context.target - (wanted - most) * normal;
    return;
  }
  // While the energy balance is negative, hold the tip still in every direction: deep inside a round object,
  // sideways of one normal is outwards of the next. Take back the outward command so far, or the tip would
  // still go there.
  const double ahead = dot(context.scene.X_WR * now.command - context.X_WH.origin(), normal);
  context.target = context.X_WH.origin() - std::max(0.0, ahead) * normal;
}

namespace {

bool engaged(const CommonState& state) { return state.mode == Mode::contact || state.mode == Mode::restore; }

// True if no tool can touch the tip. A tool that was out of view as its contact ended may press until it is
// seen clear.
bool clear_of_object(const AdmittanceContext& context, const CommonState& state, Contact& contact) {
  if (state.mode != Mode::away && state.mode != Mode::follow) return false;
  if (!context.scene.has_tracker) return true;
  const bool clear =
      context.tool_known && context.tool_fresh && context.gap > context.scene.force.tare_clearance;
  if (clear && state.tool.value.tool == contact.tool) contact.unseen = false;
  return clear && !contact.unseen;
}

Walls walls_around(const AdmittanceContext& context, CommonState& state, const AdmittanceState& now) {
  if (state.object < 0 || !state.entered) return {};
  const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld at =
      nearest(context.scene, state.object, context.scene.X_WR * now.command, state.hints.command);
  const double depth = -(at.distance + context.scene.tip_radius);
  Walls walls{at.normal.e(), depth - kSkin};
  walls.depth = -at.distance;
  if (state.mode == Mode::contact && !now.contact.below)
    walls.in = object.limit_at(state.contacts) + kSkin - depth;
  return walls;
}

}  // namespace

void rest(AdmittanceState& now) noexcept {
  now.response = ResponseState{};
  now.swing = Swing{};
  now.displacement = Vec<'N'>::zero();
}

void touch(AdmittanceContext& context, const AdmittanceTask&, CommonState& state,
           AdmittanceState& now) noexcept {
  nearest_surface(context, state, {engaged(state) ? &now.contact : nullptr});
}

void act(AdmittanceContext& context, const AdmittanceTask& task, CommonState& state,
         AdmittanceState& now) noexcept {
  grip(context);
  sense(context, state, now, clear_of_object(context, state, now.contact));  // force on the tip
  weigh(context, task, state, now);
  hold_lost(context, state, now);
  check_tip(context, state, now);
  if (holding(context)) return;
  mode(context, task, state, now);
  model(context, task, state, now);
  target(context, state, now);
  spare(context, task, state, now);
}

void guard(AdmittanceContext& context, const AdmittanceTask&, CommonState& state,
           AdmittanceState& now) noexcept {
  if (state.started) limit_command(context, state, now, walls_around(context, state, now));
}

void report(const AdmittanceContext& context, const AdmittanceTask&, CommonState& state,
            const AdmittanceState& now, Outputs& out) noexcept {
  report_common(context, state,
                engaged(state) ? Quat(now.contact.X_WN.q()) : rotation_z_to(context.normal.e()), &now.contact,
                out);
  report_displaced(context, now, out);
  out.deflection = std::max(0.0, -now.displacement.xyz[2]);
  out.first_touch =
      engaged(state) ? now.contact.X_WN * Point<'N'>(0, 0, -context.scene.tip_radius - kSkin) : Point<'W'>();
}

}  // namespace enc::stages
