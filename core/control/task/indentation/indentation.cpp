#include "core/control/task/indentation/indentation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/control/stages/guard.h"
#include "core/control/stages/report.h"

namespace enc {

// ---- Checks, before anything moves, whether the machine can carry out a programme of pushes.

namespace {

// m: distance at which the probe starts, and distance that it passes behind the object (assumed: objects are
// smaller).
constexpr double kAfar = 0.5, kFar = 1.0;
// s: acceleration and braking, for each path (assumed: programme_time() is a little longer than the motion).
constexpr double kSettling = 0.1;

// Axes of the push, as columns: towards growing polar angle, across, outward.
Mat3 axes_of(const ProbeSpec& spec) {
  const double cp = std::cos(spec.polar), sp = std::sin(spec.polar);
  const double ca = std::cos(spec.azimuth), sa = std::sin(spec.azimuth);
  Mat3 axes;
  axes.col(0) = Vec3(cp * ca, cp * sa, -sp);
  axes.col(1) = Vec3(-sa, ca, 0.0);
  axes.col(2) = Vec3(sp * ca, sp * sa, cp);
  return axes;
}

// Centre of a sphere that comes in along `inward` from afar, at its first touch of the object. A step as long
// as the gap never passes through a surface.
Point<'W'> first_touch(const Object& object, Point<'W'> centre, const Vec<'W'>& inward, double radius) {
  constexpr int kSteps = 100'000;  // a grazing sphere may need many steps
  // m; positions are no more precise than this
  const double touching = std::max(1e-12, 1e-15 * centre.e().norm());
  double way = 0.0;
  for (int i = 0; i < kSteps && way < kFar; ++i) {
    const double gap = stages::nearest(object, centre).distance - radius;
    if (gap <= touching) return centre;
    centre = centre + gap * inward;
    way += gap;
  }
  throw Error("the probe goes past the object; expected a smaller offset_mm", "probe.offset");
}

// A test rig has no user and no other parts.
void check_parts(const SceneSpec& spec) {
  if (!spec.force) throw Error("[probe] measures force, but the scene has no [force]; add it", "probe");
  if (spec.user)
    throw Error("either the machine presses ([probe]) or a user does ([user]); remove one of them", "user");
  if (spec.tracker)
    throw Error("[probe] uses no tool, so there is nothing to track; remove [tracker]", "tracker");
  if (spec.display)
    throw Error("[probe] presses a real object, so there is nothing to show; remove [display]", "display");
}

void check_sizes(const ProbeSpec& spec, const CommonScene& scene) {
  if (!(spec.radius > 0.0)) throw Error("the probe needs a radius", "probe.radius");
  if (!(spec.depth > 0.0) || spec.depth > spec.radius)
    throw Error("a push goes no deeper than the radius of the probe, or its stem would touch; lower depth_mm",
                "probe.depth");
  if (!(spec.speed > 0.0) || spec.speed > scene.reach.speed)
    throw Error("the machine cannot push that fast; lower speed_mm_s", "probe.speed");
  // The probe stands on the machine; a push from above would need the object at the machine's place.
  if (!(spec.polar >= 0.5 * M_PI - 1e-9))
    throw Error("the probe stands on the machine and pushes upwards; expected polar_deg from 90 to 180",
                "probe.polar");
}

// The path: from the machine's zero straight to above the object, then straight in.
void check_way(const IndentationTask& probe, const CommonScene& scene) {
  const Object& object = scene.objects[static_cast<std::size_t>(probe.object)];
  const auto gap = [&](const Point<'W'>& p) {
    return stages::nearest(object, p).distance - scene.tip_radius;
  };
  const auto reached = [&](const Point<'W'>& p) {
    return scene.reach.contains(Pose<'R', 'H'>(scene.X_WR.q().conjugate(), scene.X_WR.inverse() * p));
  };
  const Point<'W'> start(0, 0, 0), above = probe.at(-probe.clear), end = probe.at(probe.depth);
  if (gap(start) <= scene.force.tare_clearance)
    throw Error(
        "the object is in the way of the probe at the machine's zero, where the force zero is found; "
        "move position_mm away from it",
        "probe.object");
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const Point<'W'> going = start + share * (above - start), pushing = above + share * (end - above);
    if (!reached(going) || !reached(pushing))
      throw Error(
          "the push is outside the machine's reach; the probe's centre gets +-50, +-50 and +-25 (x, y, z "
          "of W, in millimetres) around the origin, straight axes; move position_mm",
          "probe.object");
    if (gap(going) <= 0.0)
      throw Error(
          "the way from the machine's zero to the start of the push leads through the object; move "
          "position_mm",
          "probe.object");
  }
}

}  // namespace

const ObjectSpec& probed_object(const SceneSpec& spec) {
  if (spec.objects.empty()) throw Error("[probe] needs an object to press", "probe.object");
  if (spec.probe->object.empty()) return spec.objects.front();
  const auto named = std::find_if(spec.objects.begin(), spec.objects.end(),
                                  [&](const ObjectSpec& o) { return o.name == spec.probe->object; });
  if (named == spec.objects.end())
    throw Error("no object '" + spec.probe->object + "' in the scene", "probe.object");
  return *named;
}

std::optional<IndentationTask> IndentationTask::asked(const SceneSpec& spec, const CommonScene& scene) {
  if (!spec.probe) return {};
  const ProbeSpec& from = *spec.probe;
  check_parts(spec);
  check_sizes(from, scene);
  IndentationTask probe;
  probe.object = static_cast<std::int32_t>(&probed_object(spec) - spec.objects.data());
  const Object& object = scene.objects[static_cast<std::size_t>(probe.object)];
  const Mat3 axes = axes_of(from);
  const Point<'W'> afar(Vec3(object.X_WO.p() + from.offset * axes.col(0) + kAfar * axes.col(2)));
  const Point<'W'> touch = first_touch(object, afar, Vec<'W'>(Vec3(-axes.col(2))), from.radius);
  probe.X_WN = {Quat(axes), touch};
  probe.depth = from.depth;
  probe.clear = from.clear;
  probe.speed = from.speed;
  probe.dwell = from.dwell;
  probe.rest = from.rest;
  probe.repeats = static_cast<std::int32_t>(from.repeats);
  check_way(probe, scene);
  return probe;
}

double programme_time(const CommonScene& scene, const IndentationTask& probe) {
  const Reach& reach = scene.reach;
  const double approach =
      probe.at(-probe.clear).e().norm() / reach.speed + 2.0 * reach.speed / reach.acceleration;
  const double push = 2.0 * ((probe.depth + probe.clear) / probe.speed + kSettling) + probe.dwell;
  return scene.force.tare_time + approach + kSettling + probe.rest + probe.repeats * (push + probe.rest);
}

}  // namespace enc

namespace enc::stages {

// ---- The machine as a test rig: it waits for its force zero, moves above the object, and pushes and returns
// at constant speed, again and again [VHMR 4.2].

namespace {

// m: less than the machine's step of 3 um (assumed).
constexpr double kNear = 1e-6;

// True if the set-point is at the programme's position.
bool arrived(const ManipulatorContext& context, const IndentationState& now, const Point<'W'>& wanted) {
  return (context.scene.X_WR * now.command - wanted).norm() <= kNear;
}

// The next phase, once the present one is over.
ProbePhase next_phase(const ManipulatorContext& context, const IndentationTask& probe,
                      const CommonState& state, const IndentationState& now) {
  const bool there = arrived(context, now, probe.at(now.deflection));
  switch (now.phase) {
    case ProbePhase::wait:
      return now.tared >= context.scene.force.tare_time ? ProbePhase::approach : now.phase;
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

bool at_rest(const IndentationState& now) {
  return now.phase == ProbePhase::wait || now.phase == ProbePhase::rest || now.phase == ProbePhase::done;
}

void go_on(ManipulatorContext& context, const IndentationTask& probe, CommonState& state,
           IndentationState& now) {
  if (state.mode != Mode::probe) now.deflection = -probe.clear;  // the first tick
  state.mode = Mode::probe;
  now.elapsed += context.scene.dt;
  if (const ProbePhase next = next_phase(context, probe, state, now); next != now.phase) {
    now.phase = next;
    now.elapsed = 0.0;
    if (next == ProbePhase::push) ++state.contacts;
  }
  const double way = probe.speed * context.scene.dt;
  if (now.phase == ProbePhase::push) now.deflection = std::min(now.deflection + way, probe.depth);
  if (now.phase == ProbePhase::back) now.deflection = std::max(now.deflection - way, -probe.clear);
  context.target =
      now.phase == ProbePhase::wait ? context.scene.X_WR * now.command : probe.at(now.deflection);
}

}  // namespace

// The machine's own probe replaces the tool.
void touch(ManipulatorContext& context, const IndentationTask& probe, CommonState& state,
           IndentationState&) noexcept {
  state.object = probe.object;
  if (!context.X_WH.valid()) return;
  const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld found = nearest(object, context.X_WH.origin());
  context.surface_point = found.point;
  context.normal = found.normal;
  context.gap = found.distance - context.scene.tip_radius;
}

void act(ManipulatorContext& context, const IndentationTask& probe, CommonState& state,
         IndentationState& now) noexcept {
  grip(context);
  sense(context, state, now, at_rest(now) && context.gap > context.scene.force.tare_clearance);
  hold_lost(context, state, now);
  if (!holding(context)) go_on(context, probe, state, now);
}

// The object is real, so the end of the push is the only wall.
void guard(ManipulatorContext& context, const IndentationTask& probe, CommonState& state,
           IndentationState& now) noexcept {
  if (!state.started) return;
  Walls walls{probe.X_WN.q() * Vec3::UnitZ()};
  walls.in = probe.depth - probe.deflection(context.scene.X_WR * now.command);
  limit_command(context, state, now, walls);
}

void report(const ManipulatorContext& context, const IndentationTask& probe, CommonState& state,
            const IndentationState& now, Outputs& out) noexcept {
  report_common(context, state, probe.X_WN.q(), nullptr, out);
  report_displaced(context, now, out);
  out.deflection = probe.deflection(context.X_WH.origin());
}

}  // namespace enc::stages
