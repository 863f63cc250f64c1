// The optical tracker as the core sees it. A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/frames.h"
#include "core/text/words.h"

namespace enc {

// How the tool's tip is carried on from poses that are old when they come (predict.h).
enum class Prediction : std::uint8_t { hold, constant_velocity, constant_acceleration };
constexpr auto words(Prediction) { return enum_words("hold", "constant_velocity", "constant_acceleration"); }

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
  // Sides along W of the box around its origin in which tools are followed, m: 75e-3 m^3 [VHMR 5]. The paper
  // gives the product alone.
  Vec3 volume{0.5, 0.5, 0.3};
};

}  // namespace enc
