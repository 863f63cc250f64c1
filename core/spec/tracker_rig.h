// The optical tracker as the core sees it. A part of rig_spec.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// Extrapolation of the tool's tip from poses that arrive late (predict.h).
enum class Prediction : std::uint8_t { hold, constant_velocity, constant_acceleration };
constexpr auto words(Prediction) { return enum_words("hold", "constant_velocity", "constant_acceleration"); }

// Meeting point of an approaching bare finger: the filter's extrapolation, or the touch predicted from a
// reach (reach.h).
enum class Foresight : std::uint8_t { carried_on, reach };
constexpr auto words(Foresight) { return enum_words("carried_on", "reach"); }

// Model of a reaching hand [sources/hand 4].
struct ReachBelief {
  // Share of the path covered by the first movement; standard deviation.
  double share = 0.93, scatter = 0.05;
  // Share of the path by which it ends beside its target; rms, each side.
  double aside = 0.02;
  double slowest = 0.2, fastest = 1.0;               // m/s, peak of the first movement
  double shortest = 0.20;                            // s, duration of the correcting second movement
  double touch_slowest = 0.05, touch_fastest = 0.2;  // m/s, intended at the surface
  double vaguest = 1.1e-3;                           // m rms: in a vaguer picture, noise hides a correction
};

struct TrackerRig {
  std::string driver = "sim";
  Prediction prediction = Prediction::constant_velocity;
  // m rms of a pose, along an axis, without the part common to all poses.
  double measurement_noise = 0.015e-3;
  double acceleration_noise = 0.055;  // m/s^2/sqrt(Hz): the hand's motion, for constant_velocity
  // Upper limit of acceleration_noise. A surprising pose raises it up to here, because the hand has changed
  // its speed; 0: never.
  double surprise_noise = 0.0;
  // m/s^3/sqrt(Hz): the hand's motion, for constant_acceleration (sources/tracking 4).
  double jerk_noise = 1.4;
  double longest_prediction = 0.100;  // s, then the prediction slows down and stops (sources/tracking 5)
  double stamp_late = 0.0;            // s: delay of the stamps after the exposure
  double usual_age = 0.045;  // s: due to latency, polling and jitter; an older pose is predicted and flagged
  double lost_age = 0.100;   // s: an older pose is lost (sources/tracking 5)
  double farthest = 3.0;     // m from C: a tool beyond is refused
  Foresight foresight = Foresight::carried_on;
  ReachBelief reach;
  // Sides along W of the box around W's origin in which tools are tracked, m: 75e-3 m^3 [VHMR 5]. The paper
  // gives only the product.
  Vec3 volume{0.5, 0.5, 0.3};
};

}  // namespace enc
