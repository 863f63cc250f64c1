// A first contact of the twin, watched step by step, and the same hand and tool against a contact law of its
// own: for the benchmark `impact`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/setup/scene_file.h"
#include "sim/truth/truth.h"

namespace enc::bench::impact {

inline constexpr double kWindow = 0.1;  // s from the touch, as the benchmark `session` has it

// The physics at the begin of a step, and the force of the step before.
struct Step {
  double t;                      // s
  Vec3 tip, tool, tool_v, push;  // centres, m; m/s; N on the tool, by the contact
};

struct FirstTouch {
  double at = kUnset;       // s, when they touch for the first time; unset: never
  double speed = kUnset;    // m/s, of the tool, before that
  double closing = kUnset;  // m/s, of tool and tip to each other, then
  double moving = kUnset;   // m/s, of the tip, then
  double peak = kUnset;     // N, of the contact, in any step of the window
  double sampled = kUnset;  // N, likewise, in those that end with a tick: what a look at each tick sees
  double grip = kUnset;     // N, what the hand feels: most of the grip's force in the window
  double push = kUnset;     // N s: of the contact, over the window
  int breaks = 0;           // of the contact in the window
  int long_breaks = 0;      // bounces: of 5 ms and more, and found again in the window
  double lost = 0.0;        // s, without contact in the window
  double depth = 0.0;       // m, tool into tip, at most
};

struct Watched {
  FirstTouch touch;
  std::vector<Step> steps;  // from 20 ms before the touch to the end of the window
  double cpu = kUnset;      // s of CPU for each second of experiment
  double simulated = 0.0;   // s
  std::string failure{};    // what is wrong with the run; empty: nothing
};

// Runs until the window is over, or to the end.
[[nodiscard]] Watched watch_touch(const models::Setup& setup, std::uint64_t seed);

// A contact law: k d^exponent (1 + c v), v the speed into each other, never pulls; dry friction by bristles.
struct Law {
  double stiffness = 1e5;  // N/m^exponent
  double exponent = 1.0;   // 1.5: Hertz
  double damping = 0.0;    // s/m, c
  double viscous = 0.0;    // N s/m, besides: of a linear damper
  double friction = 0.6;
};
// The same hand and tool against that law, at the machine's measured way; the hand begins anew at t = 0, so
// it must be the run's first contact, and neither drift nor a sine of tremor may be in it. `step`: s.
[[nodiscard]] FirstTouch refer(const models::Setup& setup, std::uint64_t seed, const Watched& measured,
                               const Law& law, double step);

}  // namespace enc::bench::impact
