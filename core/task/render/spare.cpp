// The passivity controller of a machine that measures force and is sent to places: between its law and its
// limits, along the normal of the contact.
//
// The hand pushes with p, and the tip goes outwards by dx: that is p dx for the hand, by the machine's own
// readings, a model is not needed. What is left of what it has put in, and never more than the object would
// hold where the tip is (its press curve), is how far out the tip may be sent: a push that is felt now, and
// that grows by the hand's stiffness on the way. So all that is still under way (dead time, servo) is paid
// before it is sent, and the limits find room to stop there.
#include <algorithm>

#include "core/task/walk.h"

namespace enc::stages {
namespace {

// Out along the normal, from the last tick on; depth and push of the object where the tip is.
Yielded yielded(const Walk& walk, const Rendering& now) {
  const Contact& contact = now.contact;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(contact.object)];
  const Vec<'W'> normal = contact.X_WN * Vec<'N'>(0, 0, 1);
  const double height = (contact.X_WN.inverse() * walk.X_WH.origin()).xyz[2];
  const double depth = -(height + walk.scene.tip_radius + kSkin);
  const double moved = now.spent.energy.on ? dot(walk.X_WH.origin() - now.spent.tip, normal) : 0.0;
  return {moved, depth, depth > 0.0 ? object.response.press(std::min(depth, object.response.limit())) : 0.0};
}

// Unknown for a moment, it is what it was.
double pressed(const Walk& walk, const Rendering& now) {
  return walk.felt.finite() ? -dot(walk.felt, now.contact.X_WN * Vec<'N'>(0, 0, 1)) : now.spent.pressed;
}

// A contact, and the way back from it, until the tip is where it waits.
bool engaged(const Walk& walk, const State& state, const Rendering& now) {
  if (state.mode == Mode::contact || state.mode == Mode::restore) return true;
  return now.spent.energy.on && state.mode == Mode::follow &&
         now.spent.energy.depth > walk.scene.follow.inset;
}

}  // namespace

void weigh(const Walk& walk, const Render&, const State& state, Rendering& now) noexcept {
  Spent& spent = now.spent;
  if (!spent.energy.on) return;
  if (!engaged(walk, state, now)) {
    spent = Spent{};
    return;
  }
  if (!walk.X_WH.valid()) return;
  const double push = pressed(walk, now);
  spent.energy.pushed = 0.5 * (spent.pressed + push);  // the trapezoid's: the hand's force goes on meanwhile
  observe(spent.energy, yielded(walk, now), 0.0);
  spent.pressed = push;
  spent.tip = walk.X_WH.origin();
}

void spare(Walk& walk, const Render& task, const State& state, Rendering& now) noexcept {
  if (task.passivity == PassivityForm::none || !engaged(walk, state, now) || !walk.X_WH.valid()) return;
  Spent& spent = now.spent;
  if (!spent.energy.on) {
    // Nothing was put in yet, and nothing is given for that an object is met deep inside.
    begin(spent.energy, yielded(walk, now), 0.0);
    spent.pressed = pressed(walk, now);
    spent.tip = walk.X_WH.origin();
  }
  const Vec<'W'> normal = now.contact.X_WN * Vec<'N'>(0, 0, 1);
  const double wanted = dot(walk.target - walk.X_WH.origin(), normal);
  const double most = way_left(spent.energy, spent.pressed, task.hand_stiffness);
  if (!(wanted > most)) return;
  walk.why |= kPassive;
  walk.target = walk.target - (wanted - most) * normal;
}

}  // namespace enc::stages
