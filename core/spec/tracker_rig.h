// The optical tracker as the core sees it. A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// How the tool's tip is carried on from poses that are old when they come (predict.h).
enum class Prediction : std::uint8_t { hold, constant_velocity, constant_acceleration };
constexpr auto words(Prediction) { return enum_words("hold", "constant_velocity", "constant_acceleration"); }

// Where a bare finger is met while it comes: where the filter carries it on, or where a reach touches
// (reach.h).
enum class Foresight : std::uint8_t { carried_on, reach };
constexpr auto words(Foresight) { return enum_words("carried_on", "reach"); }

// What is believed of a hand that reaches [sources/hand 4].
struct ReachBelief {
  double share = 0.93, scatter = 0.05;  // of the way that the first movement makes; standard deviation
  double aside = 0.02;                  // of the way, by which it ends beside its target; of each side, rms
  double slowest = 0.2, fastest = 1.0;  // m/s, peak of the first movement
  double shortest = 0.20;               // s, the second movement, which corrects
  double touch_slowest = 0.05, touch_fastest = 0.2;  // m/s, wanted where the surface is
  double vaguest = 1.1e-3;  // m rms: a picture that is known worse tells no correction from noise
};

struct TrackerRig {
  std::string driver = "sim";
  Prediction prediction = Prediction::constant_velocity;
  double measurement_noise =
      0.015e-3;  // m rms of a pose, along an axis; without what is the same in every pose
  double acceleration_noise = 0.055;  // m/s^2/sqrt(Hz): what the hand does, to constant_velocity,
  // Up to here a pose that surprises raises the former, because the hand has changed its speed; 0: none does.
  double surprise_noise = 0.0;
  double jerk_noise = 1.4;            // m/s^3/sqrt(Hz): and to constant_acceleration (sources/tracking 4)
  double longest_prediction = 0.100;  // s, then it slows down and stops (sources/tracking 5)
  double stamp_late = 0.0;            // s: stamps are this much later than the exposure
  double usual_age = 0.045;  // s: what latency, polling and jitter explain; older is predicted and flagged
  double lost_age = 0.100;   // s: older is lost (sources/tracking 5)
  double farthest = 3.0;     // m from C: beyond is not a tool
  Foresight foresight = Foresight::carried_on;
  ReachBelief reach;
  // Sides along W of the box around its origin in which tools are followed, m: 75e-3 m^3 [VHMR 5]. The paper
  // gives the product alone.
  Vec3 volume{0.5, 0.5, 0.3};
};

}  // namespace enc
