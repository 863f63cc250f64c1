// A first contact of the twin, recorded step by step, and a simulation of its hand and tool against an
// independent contact law: for the benchmark `impact`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/setup/scene_file.h"
#include "sim/truth/truth.h"

namespace enc::bench::impact {

inline constexpr double kWindow = 0.1;  // s from the touch, as in the benchmark `session`

// The state of the physics at the begin of a step, and the force of the step before.
struct Step {
  double t;                      // s
  Vec3 tip, tool, tool_v, push;  // centres, m; m/s; contact force on the tool, N
};

struct FirstTouch {
  double at = kUnset;       // s, time of the first touch; unset: no touch
  double speed = kUnset;    // m/s, speed of the tool before the touch
  double closing = kUnset;  // m/s, closing speed of tool and tip at the touch
  double moving = kUnset;   // m/s, speed of the tip at the touch
  double peak = kUnset;     // N, largest contact force of any step in the window
  double sampled = kUnset;  // N, largest contact force of the steps that end with a tick: the peak seen by
                            // sampling each tick
  double grip = kUnset;     // N, on the hand: largest force of the grip in the window
  double push = kUnset;     // N s: impulse of the contact over the window
  int breaks = 0;           // breaks of contact in the window
  int long_breaks = 0;      // bounces: breaks of 5 ms and more that end in the window
  double lost = 0.0;        // s, without contact in the window
  double depth = 0.0;       // m, tool into tip, at most
};

struct TouchRecord {
  FirstTouch touch;
  std::vector<Step> steps;  // 20 ms before the touch to the end of the window
  double cpu = kUnset;      // s of CPU for each second of experiment
  double simulated = 0.0;   // s
  std::string failure{};    // error of the run; empty: none occurred
};

// Runs until the window ends, or to the end of the run.
[[nodiscard]] TouchRecord watch_touch(const models::Setup& setup, std::uint64_t seed);

// A contact law: k d^exponent (1 + c v), where v is the closing speed; it never pulls. Dry friction by
// bristles.
struct Law {
  double stiffness = 1e5;  // N/m^exponent
  double exponent = 1.0;   // 1.5: Hertz
  double damping = 0.0;    // s/m, c
  double viscous = 0.0;    // N s/m, additional linear damper
  double friction = 0.6;
};
// Simulates the twin's hand and tool against that law, with the tip on the machine's measured path. The hand
// starts anew at t = 0, so this must be the run's first contact, without drift and without a sine of tremor.
// `step`: s.
[[nodiscard]] FirstTouch refer(const models::Setup& setup, std::uint64_t seed, const TouchRecord& measured,
                               const Law& law, double step);

}  // namespace enc::bench::impact
