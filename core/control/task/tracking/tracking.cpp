// The machine carries a clamped tool: it waits until the jaws hold it, then moves from stop to stop.
#include "core/control/task/tracking/tracking.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/stages/guard.h"
#include "core/control/stages/report.h"

namespace enc {
namespace {

constexpr std::string_view kAxes = "xyz";
// m: stops are no closer (derived: the machine's step is 3 um).
constexpr double kLeastStop = 10e-6;
// s: the jaws close; and the last micrometres of a leg (assumed: duration() is a little longer than the
// motion).
constexpr double kClosing = 1.0, kArriving = 0.05;
// m: the command is at the end of its leg (assumed: less than the machine's step of 3 um).
constexpr double kThere = 1e-6;

void check_parts(const SceneSpec& spec) {
  if (spec.user || spec.probe)
    throw Error("[travel] carries a tool and nobody presses; remove [user], [probe] or [travel]", "travel");
  if (!spec.gripper)
    throw Error("[travel] carries a clamped tool, but the scene has no [gripper]; add it", "travel");
  if (spec.display) throw Error("[travel] renders nothing; remove [display]", "display");
}

void check_numbers(const TravelSpec& spec, const CommonScene& scene) {
  if (spec.axes.empty() || spec.axes.find_first_not_of(kAxes) != std::string::npos)
    throw Error("expected axes out of x, y and z, such as \"xyz\"", "travel.axes");
  if (spec.stops.size() < 2) throw Error("expected at least two stops, such as [0, 40]", "travel.stops");
  for (std::size_t i = 1; i < spec.stops.size(); ++i)
    if (!(spec.stops[i] - spec.stops[i - 1] >= kLeastStop))
      throw Error("stops must grow, by at least 0.01 mm each", "travel.stops");
  if (!(spec.speed > 0.0) || spec.speed > scene.reach.speed)
    throw Error("the machine cannot travel that fast; lower speed_mm_s", "travel.speed");
}

void check_way(const Point<'W'>& from, const Point<'W'>& to, const CommonScene& scene) {
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i) {
    const Point<'W'> p = from + (static_cast<double>(i) / kSteps) * (to - from);
    if (!scene.reach.contains(Pose<'R', 'H'>(scene.X_WR.q().conjugate(), scene.X_WR.inverse() * p)))
      throw Error(
          "the travel leads out of the machine's reach: +-50, +-50 and +-25 (x, y, z of W, in millimetres) "
          "around the origin, straight axes; lower stops_mm or move start_mm",
          "travel.stops");
  }
}

}  // namespace

std::optional<TrackingTask> TrackingTask::asked(const SceneSpec& spec, const CommonScene& scene) {
  if (!spec.travel) return {};
  const TravelSpec& from = *spec.travel;
  check_parts(spec);
  check_numbers(from, scene);
  TrackingTask travel;
  travel.acceleration = scene.reach.acceleration;
  travel.tool_held = scene.clamped_tool >= 0;
  Point<'W'> at(0, 0, 0);
  const auto go = [&](const Point<'W'>& to, double speed, std::int32_t axis) {
    check_way(at, to, scene);
    const Vec3 way = (to - at).e();
    TravelLeg leg{to, Vec<'W'>(1, 0, 0), way.norm(), speed, from.dwell, axis, 0};
    if (leg.length > 0.0) leg.along = Vec<'W'>(Vec3(way / leg.length));
    if (axis >= 0) leg.way = way[axis] > 0.0 ? 1 : -1;
    travel.legs.push_back(leg);
    at = to;
  };
  for (std::int64_t repeat = 0; repeat < from.repeats; ++repeat)
    for (const char letter : from.axes) {
      const auto axis = static_cast<std::int32_t>(kAxes.find(letter));
      const auto stop = [&](double way) {
        return Point<'W'>(Vec3((from.start[axis] + way) * Vec3::Unit(axis)));
      };
      go(stop(from.stops.front()), scene.reach.speed, -1);
      for (std::size_t i = 1; i < from.stops.size(); ++i) go(stop(from.stops[i]), from.speed, axis);
      if (from.ways == TravelWays::one_way) continue;
      for (std::size_t i = from.stops.size() - 1; i > 0; --i) go(stop(from.stops[i - 1]), from.speed, axis);
    }
  return travel;
}

double TrackingTask::duration() const {
  double total = kClosing;
  for (const TravelLeg& leg : legs)
    total += leg.length / leg.speed + leg.speed / acceleration + kArriving + leg.dwell;
  return total;
}

namespace stages {

namespace {

void go_on(TrackingContext& context, const TrackingTask& travel, CommonState& state, TrackingState& now) {
  state.mode = Mode::travel;
  now.elapsed += context.scene.dt;
  const auto begin = [&](TravelPhase phase) {
    now.phase = phase;
    now.elapsed = 0.0;
  };
  const auto leg = [&]() -> const TravelLeg& { return travel.legs[static_cast<std::size_t>(now.leg)]; };
  const Point<'W'> command = context.scene.X_WR * now.command;
  if (now.phase == TravelPhase::wait && (!travel.tool_held || context.in.grip.value.holding)) {
    begin(TravelPhase::move);
  } else if (now.phase == TravelPhase::move && (command - leg().to).norm() <= kThere) {
    begin(TravelPhase::dwell);
  } else if (now.phase == TravelPhase::dwell && now.elapsed >= leg().dwell) {
    const bool more = travel.on_leg(now.leg + 1);
    if (more) ++now.leg;
    begin(more ? TravelPhase::move : TravelPhase::done);
  }
  const bool going = now.phase == TravelPhase::move || now.phase == TravelPhase::dwell;
  context.target = going ? leg().to : command;
}

// Moves to the pose that a procedure sends. The phase follows the motion, so that the force zero does not
// change on the way.
void go_where_sent(TrackingContext& context, const TrackingTask& travel, CommonState& state,
                   TrackingState& now) {
  state.mode = Mode::travel;
  const bool may = context.carry_target->valid() && (!travel.tool_held || context.in.grip.value.holding);
  now.phase = may ? TravelPhase::move : TravelPhase::wait;
  context.target = may ? context.carry_target->origin() : context.scene.X_WR * now.command;
}

// A straight leg has no sideways part, so each is a trapezoid of the leg's speed and the machine's whole
// acceleration.
Walls walls_around(const TrackingTask& travel, const TrackingState& now) {
  if (!travel.on_leg(now.leg)) return {};
  const TravelLeg& leg = travel.legs[static_cast<std::size_t>(now.leg)];
  Walls walls{leg.along.e()};
  walls.speed = leg.speed;
  walls.share = 1.0;
  return walls;
}

}  // namespace

void touch(TrackingContext&, const TrackingTask&, CommonState&, TrackingState&) noexcept {
}  // nothing is touched

void act(TrackingContext& context, const TrackingTask& travel, CommonState& state,
         TrackingState& now) noexcept {
  grip(context);
  sense(context, state, now, now.phase != TravelPhase::move);
  hold_lost(context, state, now);
  if (holding(context)) return;
  context.carry_target != nullptr ? go_where_sent(context, travel, state, now)
                                  : go_on(context, travel, state, now);
}

void guard(TrackingContext& context, const TrackingTask& travel, CommonState& state,
           TrackingState& now) noexcept {
  if (state.started)
    limit_command(context, state, now, context.carry_target != nullptr ? Walls{} : walls_around(travel, now));
}

void report(const TrackingContext& context, const TrackingTask&, CommonState& state, const TrackingState& now,
            Outputs& out) noexcept {
  const Pose<'R', 'H'> sent = out.manipulator.tip;
  report_common(context, state, rotation_z_to(context.normal.e()), nullptr, out);
  report_displaced(context, now, out);
  if (context.carry_target == nullptr) return;
  // The tip turns only while it may move; otherwise it keeps its rotation.
  const bool goes = now.phase == TravelPhase::move && !holding(context) && context.carry_target->valid();
  if (goes)
    out.manipulator.tip =
        Pose<'R', 'H'>(context.scene.X_WR.q().conjugate() * context.carry_target->q(), now.command);
  else if (sent.valid() && out.manipulator.tip.valid())
    out.manipulator.tip = Pose<'R', 'H'>(Quat(sent.q()), now.command);
}

}  // namespace stages
}  // namespace enc
