// The surface point nearest to the tool, its outward normal (the N frame) and the gap [VHMR 3.3].
#include <limits>
#include <utility>

#include "core/stages.h"

namespace enc::stages {

NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept {
  const Nearest found = object.surface.nearest(object.X_WO.inverse() * p);
  return {object.X_WO * found.point, object.X_WO * found.normal, found.distance};
}

NearestInWorld nearest(const Scene& scene, std::int32_t index, const Point<'W'>& p,
                       ObjectHint& hint) noexcept {
  const Object& object = scene.objects[static_cast<std::size_t>(index)];
  const Nearest found =
      object.surface.nearest(object.X_WO.inverse() * p, hint.object == index ? hint.feature : -1);
  hint = {index, found.feature};
  return {object.X_WO * found.point, object.X_WO * found.normal, found.distance};
}

namespace {

// Another object must be nearer by this much to take over, so that a tool between two does not flicker.
constexpr double kHysteresis = 1e-3;  // m

struct Candidate {
  NearestInWorld at;
  double score = std::numeric_limits<double>::infinity();
  ObjectHint hint;
};

// The nearest object. Objects whose ball is farther than the best so far are not asked; the one of last time
// is asked first, so that these are many.
Candidate nearest_object(const Scene& scene, const Point<'W'>& query, std::int32_t last, Hints& hints) {
  Candidate best;
  Candidate second;
  const auto ask = [&](std::int32_t index) {
    const double favour = index == last ? kHysteresis : 0.0;
    constexpr double kRounding = 1e-12;  // m
    if (scene.objects[static_cast<std::size_t>(index)].least_distance(query) - favour - kRounding >
        best.score)
      return;
    Candidate found;
    for (const ObjectHint& hint : hints.tool)
      if (hint.object == index) found.hint = hint;
    found.at = nearest(scene, index, query, found.hint);
    found.score = found.at.distance - favour;
    const bool tie = found.score == best.score;
    if (tie ? index < best.hint.object : !(found.score >= best.score)) std::swap(found, best);
    if (found.hint.object >= 0 && (found.score < second.score || second.hint.object < 0)) second = found;
  };
  if (last >= 0) ask(last);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (static_cast<std::int32_t>(i) != last) ask(static_cast<std::int32_t>(i));
  if (second.hint.object < 0) second.hint = hints.tool[hints.tool[0].object == best.hint.object ? 1 : 0];
  hints.tool = {best.hint, second.hint};
  return best;
}

// The point under the tool moves no faster than the tool where the object bulges, and hardly faster where it
// does not; by more only where another part has become the nearest.
void report_jump(Walk& walk, State& state, const Point<'W'>& before, const Point<'W'>& query) {
  constexpr double kJump = 1e-3;  // m, beyond the way of the tool
  // Before the first tick with a tool, `before` is unset, and that is no jump.
  const double moved = (query - before).norm();
  if ((walk.surface_point - state.last_point).norm() > moved + kJump) walk.why |= kSurfaceJump;
  state.last_query = query;
  state.last_point = walk.surface_point;
}

// The machine's own probe takes the place of the tool.
void touch_probed(Walk& walk, State& state) noexcept {
  state.object = walk.scene.probe->object;
  if (!walk.X_WH.valid()) return;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld found = nearest(object, walk.X_WH.origin());
  walk.surface_point = found.point;
  walk.normal = found.normal;
  walk.gap = found.distance - walk.scene.tip_radius;
}

}  // namespace

void touch(Walk& walk, State& state) noexcept {
  if (walk.scene.probe) return touch_probed(walk, state);
  if (walk.scene.travel) return;  // nothing is touched
  // Without a tracker the tip itself asks: it then waits at its own nearest surface point, and force alone
  // makes a contact.
  const bool by_tool = walk.scene.has_tracker;
  const Point<'W'> last_query = std::exchange(state.last_query, Point<'W'>());
  if (by_tool && !walk.tool_known) return;
  const Point<'W'> query = by_tool ? walk.tool_tip : walk.X_WH.origin();
  if (!query.finite()) return;
  const bool engaged = state.mode == Mode::contact || state.mode == Mode::restore;
  Candidate best;
  if (engaged) {
    best.hint = state.hints.tool[0];
    best.at = nearest(walk.scene, state.contact.object, query, best.hint);
    state.hints.tool[0] = best.hint;
  } else if (!walk.scene.objects.empty()) {
    best = nearest_object(walk.scene, query, state.object, state.hints);
  }
  if (best.hint.object != state.object) state.entered = false;
  state.object = best.hint.object;
  walk.surface_point = best.at.point;
  walk.normal = best.at.normal;
  if (!by_tool) return;
  walk.gap = best.at.distance - walk.tool_radius;
  report_jump(walk, state, last_query, query);
}

}  // namespace enc::stages
