// Meet by force: an arm takes its prop to where the finger will touch, and gives the force of what is touched
// [VisHap 2.3].
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/control/safety/following.h"
#include "core/control/stages/contact.h"
#include "core/control/task/meet/impedance.h"
#include "core/control/task/meet/tamed.h"
#include "core/control/track/reach.h"

namespace enc {

struct Outputs;
struct CommonState;

// What the control law remembers (impedance.h).
struct Aim {
  Point<'W'> target;  // X_d: where the tip shall be
  Vec<'W'> velocity = Vec<'W'>::zero();
  Vec<'W'> error = Vec<'W'>::zero(), error_rate = Vec<'W'>::zero();  // low-passed [eq. 3]
  double gain = 1.0;                                                 // lambda_z
  double sunk = 0.0;       // m: how far the target is behind the surface, in a button
  bool caught_up = false;  // the target is where the finger's projection is
  bool triggered = false;
  double blind = 0.0;    // s since the machine last said where it is
  Straying straying;     // from the target, where nothing but the arm itself can be why
  bool stuck = false;    // and it was for too long: until the finger has gone
  bool hurried = false;  // its velocity is one of haste
  Point<'W'> stood;      // where the tip rests while the finger is far; unset: it does not
  bool slipped = false;  // and it did not stay there
};

// The pictures of a finger that comes, newest first, and where it will touch (core/control/track/reach.h).
struct Coming {
  std::array<Point<'W'>, kSightings> at;
  std::array<Time, kSightings> exposed{};
  std::int32_t count = 0;
  std::int32_t tool = -1;  // of which finger
  bool clear = false;      // they tell where it is well enough
  // If it touched so long after `told`: x and y of N, and the logarithm of how well that fits (reach.h).
  static constexpr std::size_t kTimes = 7;
  std::array<std::array<double, 3>, kTimes> touches{};
  double passes = -HUGE_VAL;  // likewise, that it does not touch within those times
  Pose<'W', 'N'> X_WN;        // the surface under it when that was asked
  Time told{};                // when it was asked
  std::int32_t object = -1;   // of which it was; -1: nothing is known
};

struct Meeting {
  Contact contact;
  Aim aim;
  Coming coming;
  Heat heat;  // of the motors, as it is believed
  Tamed tamed;
};

struct Meet : Impedance {
  using Memory = Meeting;
};

template <class F>
void fields(F& f, Aim& r) {
  fields(f, "target_W", r.target);
  fields(f, "target_velocity_W", r.velocity);
  fields(f, "error_W", r.error);
  fields(f, "error_rate_W", r.error_rate);
  f("lambda", r.gain);
  f("sunk", r.sunk);
  f("caught_up", r.caught_up);
  f("blind", r.blind);
  f("target_fastest", r.straying.fastest);
  f("arm_off", r.straying.off);
  f("stuck", r.stuck);
  f("hurried", r.hurried);
  fields(f, "stood_W", r.stood);
  f("slipped", r.slipped);
  f("triggered", r.triggered);
}
template <class F>
void fields(F& f, Coming& r) {
  for (Point<'W'>& p : r.at) fields(f, "coming_at_W", p);
  for (Time& t : r.exposed) f("coming_exposed", t);
  f("coming_count", r.count);
  f("coming_tool", r.tool);
  f("coming_clear", r.clear);
  for (auto& touch : r.touches) fields(f, "coming_touches", touch);
  f("coming_passes", r.passes);
  fields(f, "coming_X_WN", r.X_WN);
  f("coming_told", r.told);
  f("coming_object", r.object);
}
template <class F>
void fields(F& f, Meeting& m) {
  fields(f, m.contact);
  fields(f, m.aim);
  fields(f, m.coming);
  fields(f, "winding", m.heat.winding);
  fields(f, "housing", m.heat.housing);
  fields(f, m.tamed);
}

namespace stages {
struct Walk;
void track(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
void touch(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
void act(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
void guard(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
void report(const Walk& walk, const Impedance& task, CommonState& state, const Meeting& now,
            Outputs& out) noexcept;

// The stages that act() is made of: where the prop should be; depth in, force out.
void aim(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
void impede(Walk& walk, const Impedance& task, CommonState& state, Meeting& now) noexcept;
}  // namespace stages

}  // namespace enc
