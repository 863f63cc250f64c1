// Impedance rendering: an arm moves its prop to the expected touch and exerts the force there [VisHap 2.3].
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/control/safety/following.h"
#include "core/control/stages/common_state.h"
#include "core/control/task/impedance/arm_context.h"
#include "core/control/task/impedance/impedance.h"
#include "core/control/task/impedance/passivity_control.h"
#include "core/control/track/reach.h"

namespace enc {

struct Outputs;

// State of the control law (impedance.h).
struct Aim {
  Point<'W'> target;  // X_d: commanded position of the tip
  Vec<'W'> velocity = Vec<'W'>::zero();
  Vec<'W'> error = Vec<'W'>::zero(), error_rate = Vec<'W'>::zero();  // low-passed [eq. 3]
  double gain = 1.0;                                                 // lambda_z
  double sunk = 0.0;       // m: depth of the target behind a button's surface
  bool caught_up = false;  // the target has reached the finger's projection
  bool triggered = false;
  double blind = 0.0;       // s since the machine's last position report
  PathDeviation deviation;  // deviation from the target that only the arm can cause
  bool stuck = false;       // off the target for too long, until the finger leaves
  bool hurried = false;     // the velocity uses the raised speed limit
  Point<'W'> stood;         // resting position of the tip; unset: it moves
  bool slipped = false;     // the tip did not stay where it rested
};

// Pictures of an approaching finger, newest first, and its predicted touch (core/control/track/reach.h).
struct ReachPrediction {
  std::array<Point<'W'>, kSightings> at;
  std::array<Time, kSightings> exposed{};
  std::int32_t count = 0;
  std::int32_t tool = -1;  // index of the finger
  bool clear = false;      // the pictures are accurate enough
  // The touch for each of a few times after the prediction: x and y in N, logarithm of its fit (reach.h).
  static constexpr std::size_t kTimes = 7;
  std::array<std::array<double, 3>, kTimes> touches{};
  double passes = -HUGE_VAL;  // that logarithm for no touch within those times
  Pose<'W', 'N'> X_WN;        // surface under the finger at the time of prediction
  Time told{};                // time of this prediction
  std::int32_t object = -1;   // the predicted object; -1: no prediction
};

struct ImpedanceState {
  Contact contact;
  Aim aim;
  ReachPrediction coming;
  Heat heat;  // thermal model of the motors
  PassivityControl passivity;
};

struct ImpedanceTask : Impedance {
  using Memory = ImpedanceState;
  using Context = stages::ArmContext;
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
  f("target_fastest", r.deviation.fastest);
  f("arm_off", r.deviation.off);
  f("stuck", r.stuck);
  f("hurried", r.hurried);
  fields(f, "stood_W", r.stood);
  f("slipped", r.slipped);
  f("triggered", r.triggered);
}
template <class F>
void fields(F& f, ReachPrediction& r) {
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
void fields(F& f, ImpedanceState& m) {
  fields(f, m.contact);
  fields(f, m.aim);
  fields(f, m.coming);
  fields(f, "winding", m.heat.winding);
  fields(f, "housing", m.heat.housing);
  fields(f, m.passivity);
}

namespace stages {
void track(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept;
void touch(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept;
void act(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept;
void guard(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept;
void report(const ArmContext& context, const Impedance& task, CommonState& state, const ImpedanceState& now,
            Outputs& out) noexcept;

// The stages of act(): place the prop (aim); position in, force out (render_impedance).
void aim(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& now) noexcept;
void render_impedance(ArmContext& context, const Impedance& task, CommonState& state,
                      ImpedanceState& now) noexcept;
}  // namespace stages

}  // namespace enc
