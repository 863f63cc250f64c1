#include "core/control/task/render/render.h"

#include <algorithm>

#include "core/base/rotation.h"
#include "core/control/stages/guard.h"
#include "core/control/stages/report.h"

namespace enc::stages {
namespace {

bool engaged(const CommonState& state) { return state.mode == Mode::contact || state.mode == Mode::restore; }

// Whether nothing can be on the tip. A tool that was out of view as its contact ended may still press until
// that tool is seen clear.
bool clear_of_object(const Walk& walk, const CommonState& state, Contact& contact) {
  if (state.mode != Mode::away && state.mode != Mode::follow) return false;
  if (!walk.scene.has_tracker) return true;
  const bool clear = walk.tool_known && walk.tool_fresh && walk.gap > walk.scene.force.tare_clearance;
  if (clear && state.tool.value.tool == contact.tool) contact.unseen = false;
  return clear && !contact.unseen;
}

Walls walls_around(const Walk& walk, CommonState& state, const Rendering& now) {
  if (state.object < 0 || !state.entered) return {};
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const NearestInWorld at =
      nearest(walk.scene, state.object, walk.scene.X_WR * now.command, state.hints.command);
  const double depth = -(at.distance + walk.scene.tip_radius);
  Walls walls{at.normal.e(), depth - kSkin};
  walls.depth = -at.distance;
  if (state.mode == Mode::contact && !now.contact.below)
    walls.in = object.limit_at(state.contacts) + kSkin - depth;
  return walls;
}

}  // namespace

void rest(Rendering& now) noexcept {
  now.response = ResponseState{};
  now.swing = Swing{};
  now.displacement = Vec<'N'>::zero();
}

void touch(Walk& walk, const Render&, CommonState& state, Rendering& now) noexcept {
  nearest_surface(walk, state, {engaged(state) ? &now.contact : nullptr});
}

void act(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept {
  grip(walk);
  sense(walk, state, now, clear_of_object(walk, state, now.contact));  // what force is on the tip
  weigh(walk, task, state, now);
  hold_lost(walk, state, now);
  check_tip(walk, state, now);
  if (holding(walk)) return;
  mode(walk, task, state, now);
  model(walk, task, state, now);
  target(walk, state, now);
  spare(walk, task, state, now);
}

void guard(Walk& walk, const Render&, CommonState& state, Rendering& now) noexcept {
  if (state.started) limit_command(walk, state, now, walls_around(walk, state, now));
}

void report(const Walk& walk, const Render&, CommonState& state, const Rendering& now,
            Outputs& out) noexcept {
  report_common(walk, state, engaged(state) ? Quat(now.contact.X_WN.q()) : rotation_z_to(walk.normal.e()),
                &now.contact, out);
  report_displaced(walk, now, out);
  out.deflection = std::max(0.0, -now.displacement.xyz[2]);
  out.first_touch =
      engaged(state) ? now.contact.X_WN * Point<'N'>(0, 0, -walk.scene.tip_radius - kSkin) : Point<'W'>();
}

}  // namespace enc::stages
