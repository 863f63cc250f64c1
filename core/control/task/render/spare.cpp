// The passivity controller of a machine that measures force and is sent to places: between its law and its
// limits, along the normal of the contact.
//
// The hand pushes with p, and the tip goes outwards by dx: that is p dx for the hand, by the machine's own
// readings, a model is not needed. What is left of what it has put in, and never more than the object would
// hold where the tip is (its press curve), is how far out the tip may be sent: against a push that is felt
// now, or that a hand which is met at once begins with, and that grows on the way as the hand comes. So all
// that is still under way (dead time, servo) is paid before it is sent, and the limits find room to stop
// there.
#include <algorithm>

#include "core/control/stages/walk.h"
#include "core/control/task/render/render.h"

namespace enc::stages {
namespace {

// m: farther from the tool, nothing is met. What a tracker is late and off by, and the tip needs to stop in.
constexpr double kNearHand = 3e-3;
constexpr double kMet = 0.8;    // N, that a hand begins with which meets the tip. Chosen.
constexpr double kComes = 2.0;  // times its stiffness: it comes as fast as the tip goes. Chosen.
// m, that it comes on its own while the tip is stopped (dead time, servo): 20 mm/s for 55 ms. Chosen.
constexpr double kComesOn = 1.1e-3;

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

// m, outwards, that nothing is met on: the tool is farther than that, by where it is seen.
double free_way(const Walk& walk, double depth, double push) {
  if (!walk.tool_known || !walk.tool_fresh || push >= walk.scene.force.contact) return 0.0;
  return std::max(0.0, walk.gap + depth - kNearHand);
}

// N, of a hand that pushes and cannot pull. Unknown for a moment, it is what it was. Where nothing can be met
// it is the sensor's error.
double pressed(const Walk& walk, const Rendering& now, double depth) {
  if (!walk.felt.finite()) return now.spent.pressed;
  const double push = -dot(walk.felt, now.contact.X_WN * Vec<'N'>(0, 0, 1));
  return free_way(walk, depth, push) > 0.0 ? 0.0 : std::max(0.0, push);
}

// A contact, and the way back from it, until the tip is where it waits.
bool engaged(const Walk& walk, const CommonState& state, const Rendering& now) {
  if (state.mode == Mode::contact || state.mode == Mode::restore) return true;
  return now.spent.energy.on && state.mode == Mode::follow &&
         now.spent.energy.depth > walk.scene.follow.inset;
}

}  // namespace

void weigh(const Walk& walk, const Render&, const CommonState& state, Rendering& now) noexcept {
  Spent& spent = now.spent;
  if (!spent.energy.on) return;
  if (!engaged(walk, state, now)) {
    spent = Spent{};
    return;
  }
  if (!walk.X_WH.valid()) return;
  const Yielded tick = yielded(walk, now);
  const double push = pressed(walk, now, tick.depth);
  const auto [least, most] = std::minmax(spent.pressed, push);
  // The hand's force goes on meanwhile: the trapezoid's. When a touch began or ended between two ticks is not
  // known: it may have been all of what came out, and none of what was put in.
  const bool whole = least >= walk.scene.force.contact;
  spent.energy.pushed = whole ? 0.5 * (least + most) : tick.moved > 0.0 ? most : least;
  // What the sensor is off by is nobody's: inwards a hand pushes with so much less, outwards with so much
  // more.
  if (whole) spent.energy.pushed += std::copysign(walk.scene.force.threshold, tick.moved);
  observe(spent.energy, tick, 0.0);
  // What is owed ends with its contact: a tip that nobody pushes any more does not wait for one who pays.
  if (state.mode == Mode::follow && push < walk.scene.force.contact)
    spent.energy.left = std::max(0.0, spent.energy.left);
  spent.pressed = push;
  spent.tip = walk.X_WH.origin();
}

void spare(Walk& walk, const Render& task, const CommonState& state, Rendering& now) noexcept {
  if (task.passivity == PassivityForm::none || !engaged(walk, state, now) || !walk.X_WH.valid()) return;
  Spent& spent = now.spent;
  if (!spent.energy.on) {
    // Nothing was put in yet, and nothing is given for that an object is met deep inside.
    const Yielded tick = yielded(walk, now);
    begin(spent.energy, tick, 0.0);
    spent.pressed = pressed(walk, now, tick.depth);
    spent.tip = walk.X_WH.origin();
  }
  const Vec<'W'> normal = now.contact.X_WN * Vec<'N'>(0, 0, 1);
  const double wanted = dot(walk.target - walk.X_WH.origin(), normal);
  // Noise owes something, too: nobody is there to pay it.
  const bool pushed = spent.pressed >= walk.scene.force.contact;
  const double comes_on = state.mode == Mode::follow ? 0.0 : kComesOn * task.hand_stiffness;
  const double push = std::max(kMet, spent.pressed) + comes_on;
  const double most = free_way(walk, spent.energy.depth, spent.pressed) +
                      way_left(spent.energy, pushed ? 0.0 : kForgiven, push, kComes * task.hand_stiffness);
  if (!(wanted > most)) return;
  walk.why |= kPassive;
  if (!pushed || spent.energy.left >= 0.0) {
    walk.target = walk.target - (wanted - most) * normal;
    return;
  }
  // Who owes stands still under the hand, sideways too: deep inside an object that is round the side of one
  // normal is outwards by the next. What it was sent out by already is taken back, or it would go there.
  const double ahead = dot(walk.scene.X_WR * now.command - walk.X_WH.origin(), normal);
  walk.target = walk.X_WH.origin() - std::max(0.0, ahead) * normal;
}

}  // namespace enc::stages
