#include "core/control/stages/step_context.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace enc::stages {

// ---- Pose of the tool and its tip at this tick: the newest pose extrapolated to now, with a check of its
// age [VHMR 3.3].

namespace {

// The tracker reports either both of its uncertainties or none.
bool tells_noise(const TrackedTool& tool, double most) {
  const auto possible = [most](double noise) { return noise >= 0.0 && noise < most; };
  const bool silent = std::isnan(tool.along) && std::isnan(tool.across);
  return silent || (possible(tool.along) && possible(tool.across));
}

bool plausible(const StepContext& context, const Measurement<TrackedTool>& sample) {
  const auto& tool = sample.value;
  return tells_noise(tool, context.scene.tracker.farthest) && tool.X_CT.valid() &&
         tool.X_CT.p().norm() < context.scene.tracker.farthest && tool.tool >= 0 &&
         tool.tool < static_cast<int>(context.scene.tools.size()) &&
         sample.t <= context.tick.t + context.tick.dt;
}

// A pose is old by its age, or because the tracker's next two are missing. The second one may be late by half
// a period.
void judge_age(StepContext& context, CommonState& state) {
  constexpr double kPeriods = 2.5;
  const double old = age(context.tick.t, exposed(context.scene.tracker, state.tool.t));
  state.tool_missing = age(context.tick.t, state.tool_came) * context.scene.tracker.rate > kPeriods;
  context.tool_fresh = old <= context.scene.tracker.usual_age && !state.tool_missing;
  if (context.tool_fresh) return;
  if (old <= context.scene.tracker.lost_age) {
    context.why |= kToolPredicted;
  } else if (state.mode == Mode::away) {
    context.tool_known = false;  // mode is away: a tool out of sight is simply away
    context.why |= kToolUnseen;
  } else {
    context.why |= kToolLost;
  }
}

void take_in(const StepContext& context, CommonState& state, bool pressing) {
  const TrackerRig& rig = context.scene.tracker;
  if (rig.prediction == Prediction::hold) return;
  const TrackedTool& pose = state.tool.value;
  const Point<'T'>& tip = context.scene.tools[static_cast<std::size_t>(pose.tool)].tip.centre;
  observe(rig, pose.tool, exposed(rig, state.tool.t), context.scene.X_WC * (pose.X_CT * tip),
          noise_of(rig, pose, context.scene.X_WC), state.tip_motion, pressing);
}

// The path from `from` to `to` ends where the tool's tip meets the haptic-tip. A prediction ignores a touch
// until the poses show it, and would carry the tool right through the machine.
Point<'W'> stopped_by_tip(const StepContext& context, double tool_radius, const Point<'W'>& from,
                          const Point<'W'>& to) {
  if (!context.X_WH.valid()) return to;
  const double apart = tool_radius + context.scene.tip_radius;
  const Vec3 c = (from - context.X_WH.origin()).e();
  const Vec3 way = (to - from).e();
  const double toward = -c.dot(way);
  if (toward <= 0.0) return to;
  const double outside = c.squaredNorm() - apart * apart;
  if (outside <= 0.0) return Point<'W'>(Vec3(from.e() + way + (toward / c.squaredNorm()) * c));  // slides
  const double root = toward * toward - way.squaredNorm() * outside;
  if (root <= 0.0) return to;  // passes by
  const double share = (toward - std::sqrt(root)) / way.squaredNorm();
  return share < 1.0 ? Point<'W'>(Vec3(from.e() + share * way)) : to;
}

// Extrapolates the tip from the newest pose. The tool moves with the tip and keeps that pose's rotation: its
// rotation is not rendered, and its effect on the tip is part of the tip's own motion.
void carry_on(StepContext& context, const CommonState& state, bool stopped) {
  const TipMotion& motion = state.tip_motion;
  const double radius = context.scene.tools[static_cast<std::size_t>(motion.tool)].tip.radius;
  const Point<'W'> ahead = predict(context.scene.tracker, motion, context.tick.t);
  const Point<'W'> tip = stopped ? stopped_by_tip(context, radius, motion.position, ahead) : ahead;
  context.X_WT = {context.X_WT.q(), context.X_WT.origin() + (tip - context.tool_tip)};
  context.tool_tip = tip;
}

}  // namespace

void track_tool(StepContext& context, CommonState& state, const ToolAtTip& at_tip) noexcept {
  if (!context.scene.has_tracker) return;
  const auto& sample = context.in.tool;
  if (sample.health == Health::fault) context.why |= kTrackerFault;
  if (sample.health == Health::ok && sample.value.tool != -1) {  // -1: no tool recognised, which is no fault
    if (!plausible(context, sample)) {
      context.why |= kToolInvalid;
    } else if (state.tool.health == Health::absent || sample.t > state.tool.t) {
      state.tool = sample;  // older or repeated packets change nothing
      state.tool_came = context.tick.t;
      take_in(context, state, at_tip.pressing);
    }
  }
  if (state.tool.health != Health::ok) {
    context.why |= kToolUnseen;
    return;
  }
  // A clamped tool is seen, recorded and drawn, but it presses nothing: it moves with the tip.
  context.tool_known = state.tool.value.tool != context.scene.clamped_tool;
  const Tool& tool = context.scene.tools[static_cast<std::size_t>(state.tool.value.tool)];
  context.X_WT = context.scene.X_WC * state.tool.value.X_CT;
  context.tool_tip = context.X_WT * tool.tip.centre;
  context.X_WT_newest = context.X_WT;
  context.tip_newest = context.tool_tip;
  if (context.scene.tracker.prediction != Prediction::hold) carry_on(context, state, at_tip.stopped);
  context.tool_radius = tool.tip.radius;
  judge_age(context, state);
}

// ---- The surface point nearest to the tool, its outward normal (the N frame) and the gap [VHMR 3.3].

NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept {
  const SurfacePoint found = object.surface.nearest(object.X_OW * p);
  return {object.X_WO * found.point, object.X_WO * found.normal, found.distance};
}

NearestInWorld nearest(const CommonScene& scene, std::int32_t index, const Point<'W'>& p,
                       ObjectHint& hint) noexcept {
  const Object& object = scene.objects[static_cast<std::size_t>(index)];
  const SurfacePoint found =
      object.surface.nearest(object.X_OW * p, hint.object == index ? hint.feature : -1);
  hint = {index, found.feature};
  return {object.X_WO * found.point, object.X_WO * found.normal, found.distance};
}

namespace {

// Query of the objects in this tick: for the finger or the tool, or for the tip.
struct Query {
  const CommonScene& scene;
  std::span<const MoverState> moved;
  Point<'W'> p;
  double radius = 0.0;         // radius of the finger, tool or tip, m
  bool touched_first = false;  // prefer any touched object to every untouched one
};

// The surface at its present position.
NearestInWorld nearest(const Query& query, std::int32_t index, ObjectHint& hint) noexcept {
  const Object& object = query.scene.objects[static_cast<std::size_t>(index)];
  if (object.moving < 0) return stages::nearest(query.scene, index, query.p, hint);
  const Vec<'W'> shift = shift_of(object, query.moved);
  NearestInWorld found = stages::nearest(query.scene, index, query.p - shift, hint);
  found.point = found.point + shift;
  return found;
}

double least_distance(const Query& query, const Object& object) {
  return object.least_distance(object.moving < 0 ? query.p : query.p - shift_of(object, query.moved));
}

struct Candidate {
  NearestInWorld at;
  double score = std::numeric_limits<double>::infinity();
  ObjectHint hint;
};

bool is_button(const Query& query, std::int32_t index) {
  const Surface& surface = query.scene.objects[static_cast<std::size_t>(index)].surface;
  return std::holds_alternative<Button>(surface.shape());
}
// Only the face of a button is touched. Beside the face, the gap is the distance to its edge.
bool beside(const Query& query, const ObjectHint& at) {
  return at.feature == kButtonSide && is_button(query, at.object);
}

// The object with the smallest score is chosen. Another object must be nearer than the previous one by
// follow.hysteresis, so that a tool between two does not make the choice flicker. An arm renders touch, so
// for an arm any touched object precedes all others.
constexpr double kTouched = 10.0;  // m
double score_of(const Query& query, const Candidate& found, double favour) {
  const bool first = query.touched_first && found.at.distance <= query.radius && !beside(query, found.hint);
  return found.at.distance - favour - (first ? kTouched : 0.0);
}
double least_score(const Query& query, const Object& object) {
  const double least = least_distance(query, object);
  return query.touched_first && least <= query.radius ? least - kTouched : least;
}

// The nearest object. Objects whose bounding ball is farther than the best so far are skipped. The previous
// object is queried first, so that this skips many.
Candidate nearest_object(const Query& query, std::int32_t last, Hints& hints) {
  const std::vector<Object>& objects = query.scene.objects;
  Candidate best;
  Candidate second;
  const auto ask = [&](std::int32_t index) {
    constexpr double kRounding = 1e-12;  // m
    if (least_score(query, objects[static_cast<std::size_t>(index)]) - kRounding > best.score) return;
    Candidate found;
    for (const ObjectHint& hint : hints.tool)
      if (hint.object == index) found.hint = hint;
    found.at = nearest(query, index, found.hint);
    found.score = score_of(query, found, index == last ? query.scene.follow.hysteresis : 0.0);
    const bool tie = found.score == best.score;
    if (tie ? index < best.hint.object : !(found.score >= best.score)) std::swap(found, best);
    if (found.hint.object >= 0 && (found.score < second.score || second.hint.object < 0)) second = found;
  };
  if (last >= 0) ask(last);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (static_cast<std::int32_t>(i) != last) ask(static_cast<std::int32_t>(i));
  if (second.hint.object < 0) second.hint = hints.tool[hints.tool[0].object == best.hint.object ? 1 : 0];
  hints.tool = {best.hint, second.hint};
  return best;
}

// Position of the finger or the tool after follow.ahead, but not beyond the first surface on its path. A
// machine needs time to move from one object to the next, and a hand on an oblique path changes its nearest
// object late.
Query predicted(const Query& query, const Vec<'W'>& velocity, double clear) {
  Query later = query;
  const double way = query.scene.follow.ahead * velocity.norm();
  if (way > 0.0)
    later.p = query.p + (query.scene.follow.ahead * std::min(1.0, std::max(0.0, clear) / way)) * velocity;
  return later;
}

// The nearest object. If the scene looks ahead, it is the object nearest at the extrapolated time or at the
// predicted touch.
Candidate chosen_object(const Query& query, const CommonState& state, const Point<'W'>& comes_to,
                        Hints& hints) {
  const Candidate here = nearest_object(query, state.object, hints);
  const Vec<'W'>& velocity = state.tip_motion.velocity;
  const double clear = here.at.distance - query.radius;
  if (query.scene.follow.ahead == 0.0 || !velocity.finite()) return here;
  Query later = predicted(query, velocity, clear);
  if (comes_to.finite() && clear > 0.0) later.p = comes_to;
  Candidate there = nearest_object(later, state.object, hints);
  there.at = nearest(query, there.hint.object, there.hint);
  return there;
}

// Surface of the object in contact. A finger at the rim of a button presses it until it is clearly beside it.
NearestInWorld pressed_surface(const Query& query, std::int32_t index, ObjectHint& hint) {
  const Object& object = query.scene.objects[static_cast<std::size_t>(index)];
  Query over = query;
  if (is_button(query, index)) {
    const Vec<'W'> shift = shift_of(object, query.moved);
    const Point<'O'> p = object.X_OW * (query.p - shift);
    over.p = object.X_WO * object.surface.over_face(p, query.scene.contact.leave_gap) + shift;
  }
  return nearest(over, index, hint);
}

// m: the surface point moves this much farther than the tool only if another part has become the nearest
// (assumed: no source).
constexpr double kJump = 1e-3;

// Over a bulge, the point under the tool moves no faster than the tool, and elsewhere hardly faster. It moves
// farther only if another part has become the nearest.
void report_jump(StepContext& context, CommonState& state, const Point<'W'>& before,
                 const Point<'W'>& query) {
  // Before the first tick with a tool, `before` is unset, and that is no jump.
  const double moved = (query - before).norm();
  if ((context.surface_point - state.last_point).norm() > moved + kJump) context.why |= kSurfaceJump;
  state.last_query = query;
  state.last_point = context.surface_point;
}

}  // namespace

void nearest_surface(StepContext& context, CommonState& state, const SurfaceQuery& asked) noexcept {
  // Without a tracker the tip itself is the query. It then waits at its own nearest surface point, and force
  // alone makes a contact.
  const bool by_tool = context.scene.has_tracker;
  const Point<'W'> last_query = std::exchange(state.last_query, Point<'W'>());
  if (by_tool && !context.tool_known) return;
  const Query query{context.scene, asked.moved, by_tool ? context.tool_tip : context.X_WH.origin(),
                    context.tool_radius, asked.touched_first};
  if (!query.p.finite()) return;
  Candidate best;
  if (asked.engaged != nullptr) {
    best.hint = state.hints.tool[0];
    best.at = pressed_surface(query, asked.engaged->object, best.hint);
    state.hints.tool[0] = best.hint;
  } else if (!context.scene.objects.empty()) {
    best = chosen_object(query, state, asked.comes_to, state.hints);
  }
  if (best.hint.object != state.object) state.entered = false;
  state.object = best.hint.object;
  context.surface_point = best.at.point;
  context.normal = best.at.normal;
  if (!by_tool) return;
  context.gap = best.hint.object >= 0 && beside(query, best.hint) ? best.at.distance
                                                                  : best.at.distance - context.tool_radius;
  report_jump(context, state, last_query, query.p);
}

}  // namespace enc::stages
