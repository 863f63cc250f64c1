// The surface point nearest to the tool, its outward normal (the N frame) and the gap [VHMR 3.3].
#include "core/stages.h"

namespace enc::stages {

NearestInWorld nearest(const Object& object, const Point<'W'>& p) noexcept {
  const Nearest found = object.surface.nearest(object.X_WO.inverse() * p);
  return {object.X_WO * found.point, object.X_WO * found.normal, found.distance};
}

namespace {

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
  // Without a tracker the tip itself asks: it then waits at its own nearest surface point, and force alone
  // makes a contact.
  const bool by_tool = walk.scene.has_tracker;
  if (by_tool && !walk.tool_known) return;
  const Point<'W'> query = by_tool ? walk.tool_tip : walk.X_WH.origin();
  if (!query.finite()) return;
  const bool engaged = state.mode == Mode::contact || state.mode == Mode::restore;
  // Another object must be nearer by this much to take over, so that a tool between two does not flicker.
  constexpr double kHysteresis = 1e-3;
  NearestInWorld best;
  std::int32_t chosen = -1;
  double best_score = 0.0;
  for (std::size_t i = 0; i < walk.scene.objects.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    if (engaged && index != state.contact.object) continue;
    const NearestInWorld found = nearest(walk.scene.objects[i], query);
    const double score = found.distance - (index == state.object ? kHysteresis : 0.0);
    if (chosen >= 0 && score >= best_score) continue;
    best = found;
    best_score = score;
    chosen = index;
  }
  if (chosen != state.object) state.entered = false;
  state.object = chosen;
  walk.surface_point = best.point;
  walk.normal = best.normal;
  if (by_tool) walk.gap = best.distance - walk.tool_radius;
}

}  // namespace enc::stages
