// The machine as a test rig: it waits for its force zero, goes above the object, and pushes and returns at a
// steady speed, again and again [VHMR 4.2].
#include <algorithm>

#include "core/task/walk.h"

namespace enc::stages {
namespace {

// The set-point is where the programme wants it.
bool arrived(const Walk& walk, const State& state, const Point<'W'>& wanted) {
  constexpr double kNear = 1e-6;  // m
  return (walk.scene.X_WR * state.command - wanted).norm() <= kNear;
}

// The phase that follows once this one is over.
ProbePhase next_phase(const Walk& walk, State& state) {
  const Probe& probe = *walk.scene.probe;
  const Probing& now = state.probing;
  const bool there = arrived(walk, state, probe.at(now.deflection));
  switch (now.phase) {
    case ProbePhase::wait:
      return state.tared >= walk.scene.force.tare_time ? ProbePhase::approach : now.phase;
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

}  // namespace

void probe(Walk& walk, State& state) noexcept {
  const Probe& probe = *walk.scene.probe;
  Probing& now = state.probing;
  if (state.mode != Mode::probe) now.deflection = -probe.clear;  // the first tick
  state.mode = Mode::probe;
  now.elapsed += walk.scene.dt;
  if (const ProbePhase next = next_phase(walk, state); next != now.phase) {
    now.phase = next;
    now.elapsed = 0.0;
    if (next == ProbePhase::push) ++state.contacts;
  }
  const double way = probe.speed * walk.scene.dt;
  if (now.phase == ProbePhase::push) now.deflection = std::min(now.deflection + way, probe.depth);
  if (now.phase == ProbePhase::back) now.deflection = std::max(now.deflection - way, -probe.clear);
  walk.target = now.phase == ProbePhase::wait ? walk.scene.X_WR * state.command : probe.at(now.deflection);
}

}  // namespace enc::stages
