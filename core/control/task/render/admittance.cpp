// Force in, displacement out [VHMR 3.4]; and where the tip should therefore be.
#include <algorithm>
#include <cmath>

#include "core/control/safety/inside.h"
#include "core/control/stages/walk.h"
#include "core/control/task/render/render.h"

namespace enc::stages {
namespace {

// Sideways give of the contact point, never more than the deflection limit.
Vec3 tangential_give(const Object& object, const Vec<'N'>& force, double limit) {
  if (object.tangential == Tangential::stick) return Vec3::Zero();
  Vec3 give(force.xyz[0] / object.tangential_stiffness, force.xyz[1] / object.tangential_stiffness, 0.0);
  const double size = give.norm();
  return size > limit ? Vec3(give * (limit / size)) : give;
}

// m: by so much below it the tip comes to a tool that is inside already. The machine is late by some 2 mm of
// a tool that goes on at 30 mm/s.
constexpr double kBelow = 3e-3;

// What the object carries of the pressing force; the rest is the damper's.
double carried(const Walk& walk, const Render& task, const Object& object, Rendering& now, double force,
               double pressed, double limit) {
  if (!task.damping) return pressed;
  const DampingLaw& law = *task.damping;
  Swing& swing = now.swing;
  const double depth = -(now.contact.X_WN.inverse() * walk.X_WH.origin()).xyz[2] - walk.scene.tip_radius;
  if (std::isnan(swing.depth)) {
    const double near = 1e-3 * limit;
    swing = law.begin(object.response.press(near) / near, force, depth);
  }
  const double damping = law.observe(swing, force, depth);
  swing.carried = law.carry(object.response, now.response, swing.carried, pressed, damping, limit);
  return swing.carried;
}

// Beside an edge the tip cannot be right under the tool: it waits as near as the whole of it is inside.
Point<'W'> inside(const Walk& walk, CommonState& state, std::int32_t object, double margin,
                  const Point<'W'>& wanted) {
  return Inside(walk.scene, object, margin, Vec<'W'>::zero(), state.hints.command).nearest_to(wanted);
}

// Straight under the surface point: of what is round or flat that is inside, of a mesh it may be another
// side.
Point<'W'> under_surface(const Walk& walk, CommonState& state, double margin) {
  const Point<'W'> under = walk.surface_point - margin * walk.normal;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  const bool mesh = std::holds_alternative<MeshSurface>(object.surface.shape());
  return mesh ? inside(walk, state, state.object, margin, under) : under;
}

}  // namespace

void model(Walk& walk, const Render& task, CommonState& state, Rendering& now) noexcept {
  const Contact& contact = now.contact;
  if (state.mode != Mode::contact || now.contact.below) {
    rest(now);
    return;
  }
  if (!walk.force.finite()) return;  // no zero yet: stay at the surface
  const Object& object = walk.scene.objects[static_cast<std::size_t>(contact.object)];
  const Vec<'N'> force = contact.X_WN.inverse() * walk.force;
  const double pressed = std::max(0.0, -force.xyz[2] - walk.scene.force.threshold);
  const double limit = object.limit_at(state.contacts);
  const double deflection = object.response.deflection(
      now.response, carried(walk, task, object, now, -force.xyz[2], pressed, limit), limit);
  if (deflection >= limit) walk.why |= kAtLimit;
  // The limit is such that the object never asks for this much (scene.cpp): the target stays where it is.
  if (pressed > walk.scene.strength) walk.why |= kOverload;
  const Vec3 sideways = tangential_give(object, force, limit);
  now.displacement = Vec<'N'>(sideways.x(), sideways.y(), -deflection);
}

void target(Walk& walk, CommonState& state, const Rendering& now) noexcept {
  const double radius = walk.scene.tip_radius;
  switch (state.mode) {
    case Mode::follow:
      walk.target = under_surface(walk, state, radius + walk.scene.follow.inset);
      break;
    case Mode::contact:
    case Mode::restore: {
      const double below = now.contact.below ? kBelow + std::max(0.0, -walk.gap) : 0.0;
      const Vec3 d = now.displacement.e() - below * Vec3::UnitZ();
      // Sideways along the tangent plane would lead out of a round object.
      walk.target = inside(walk, state, now.contact.object, radius + kSkin,
                           now.contact.X_WN * Point<'N'>(d.x(), d.y(), d.z() - radius - kSkin));
      break;
    }
    case Mode::away:
    case Mode::hold:
    case Mode::probe:
    case Mode::travel:
      walk.target = walk.scene.X_WR * now.command;
      break;
  }
}

}  // namespace enc::stages
