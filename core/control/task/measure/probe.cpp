// The machine as a test rig: it waits for its force zero, goes above the object, and pushes and returns at a
// steady speed, again and again [VHMR 4.2].
#include "core/control/task/measure/probe.h"

#include <algorithm>

#include "core/control/stages/guard.h"
#include "core/control/stages/report.h"

namespace enc::stages {
namespace {

// m: less than the machine's step of 3 um (assumed).
constexpr double kNear = 1e-6;

// The set-point is where the programme wants it.
bool arrived(const Walk& walk, const Probing& now, const Point<'W'>& wanted) {
  return (walk.scene.X_WR * now.command - wanted).norm() <= kNear;
}

// The phase that follows once this one is over.
ProbePhase next_phase(const Walk& walk, const Probe& probe, const CommonState& state, const Probing& now) {
  const bool there = arrived(walk, now, probe.at(now.deflection));
  switch (now.phase) {
    case ProbePhase::wait:
      return now.tared >= walk.scene.force.tare_time ? ProbePhase::approach : now.phase;
    case ProbePhase::approach:
      return there ? ProbePhase::rest : now.phase;
    case ProbePhase::rest:
      if (now.elapsed < probe.rest) return now.phase;
      return state.contacts < probe.repeats ? ProbePhase::push : ProbePhase::done;
    case ProbePhase::push:
      return there && now.deflection >= probe.depth ? ProbePhase::dwell : now.phase;
    case ProbePhase::dwell:
      return now.elapsed >= probe.dwell ? ProbePhase::back : now.phase;
    case ProbePhase::back:
      return there && now.deflection <= -probe.clear ? ProbePhase::rest : now.phase;
    case ProbePhase::done:
      break;
  }
  return ProbePhase::done;
}

bool at_rest(const Probing& now) {
  return now.phase == ProbePhase::wait || now.phase == ProbePhase::rest || now.phase == ProbePhase::done;
}

void go_on(Walk& walk, const Probe& probe, CommonState& state, Probing& now) {
  if (state.mode != Mode::probe) now.deflection = -probe.clear;  // the first tick
  state.mode = Mode::probe;
  now.elapsed += walk.scene.dt;
  if (const ProbePhase next = next_phase(walk, probe, state, now); next != now.phase) {
    now.phase = next;
    now.elapsed = 0.0;
    if (next == ProbePhase::push) ++state.contacts;
  }
  const double way = probe.speed * walk.scene.dt;
  if (now.phase == ProbePhase::push) now.deflection = std::min(now.deflection + way, probe.depth);
  if (now.phase == ProbePhase::back) now.deflection = std::max(now.deflection - way, -probe.clear);
  walk.target = now.phase == ProbePhase::wait ? walk.scene.X_WR * now.command : probe.at(now.deflection);
}

}  // namespace

// The machine's own probe takes the place of the tool.
void touch(Walk& walk, const Probe& probe, CommonState& state, Probing&) noexcept {
  state.object = probe.object;
  if (!walk.X_WH.valid()) return;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld found = nearest(object, walk.X_WH.origin());
  walk.surface_point = found.point;
  walk.normal = found.normal;
  walk.gap = found.distance - walk.scene.tip_radius;
}

void act(Walk& walk, const Probe& probe, CommonState& state, Probing& now) noexcept {
  grip(walk);
  sense(walk, state, now, at_rest(now) && walk.gap > walk.scene.force.tare_clearance);
  hold_lost(walk, state, now);
  if (!holding(walk)) go_on(walk, probe, state, now);
}

// Nothing but the end of the push stands in the way: the object is real.
void guard(Walk& walk, const Probe& probe, CommonState& state, Probing& now) noexcept {
  if (!state.started) return;
  Walls walls{probe.X_WN.q() * Vec3::UnitZ()};
  walls.in = probe.depth - probe.deflection(walk.scene.X_WR * now.command);
  limit_command(walk, state, now, walls);
}

void report(const Walk& walk, const Probe& probe, CommonState& state, const Probing& now,
            Outputs& out) noexcept {
  report_common(walk, state, probe.X_WN.q(), nullptr, out);
  report_displaced(walk, now, out);
  out.deflection = probe.deflection(walk.X_WH.origin());
}

}  // namespace enc::stages
