// Optical tracker, stereo camera and display as the core sees them. Parts of rig_spec.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/base/words.h"

namespace enc {

// Extrapolation of the tool's tip from poses that arrive late (predict.h).
enum class Prediction : std::uint8_t { hold, constant_velocity, constant_acceleration };
constexpr auto words(Prediction) { return enum_words("hold", "constant_velocity", "constant_acceleration"); }

// Meeting point of an approaching bare finger: the filter's extrapolation, or the touch predicted from a
// reach (reach.h).
enum class TouchPrediction : std::uint8_t { carried_on, reach };
constexpr auto words(TouchPrediction) { return enum_words("carried_on", "reach"); }

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

// The optical tracker.
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
  // Hz, of new poses: a pose is also old once the next two are missing; unset: only by its age.
  double rate = kUnset;
  double lost_age = 0.100;  // s: an older pose is lost (sources/tracking 5)
  double farthest = 3.0;    // m from C: a tool beyond is refused
  TouchPrediction foresight = TouchPrediction::carried_on;
  ReachBelief reach;
  // Sides along W of the box around W's origin in which tools are tracked, m: 75e-3 m^3 [VHMR 5]. The paper
  // gives only the product.
  Vec3 volume{0.5, 0.5, 0.3};
};

// A pinhole with radial and tangential distortion, in OpenCV's order: k1, k2, p1, p2, k3.
struct Lens {
  double focal_x = 721.0, focal_y = 721.0;    // px
  double centre_x = 319.5, centre_y = 239.5;  // px
  std::array<double, 5> distortion{0, 0, 0, 0, 0};
};
// Square pixels, the axis through the middle of the image, no distortion. `focal` in px.
[[nodiscard]] inline Lens pinhole(std::int64_t width, std::int64_t height, double focal) {
  return {focal, focal, 0.5 * static_cast<double>(width - 1), 0.5 * static_cast<double>(height - 1)};
}

// The stereo head: rig table [camera], or a file written by `encounter calibrate stereo`. Left camera C: x
// along the image's rows, y down its columns, z into the scene. STH-MDCS with 7.5 mm lenses, 1280 x 960
// binned to 640 x 480 (sources/tracking 7).
struct StereoRig {
  std::string driver = "none";
  std::string calibration;                 // file with the other keys; empty: the numbers here
  std::int64_t width = 640, height = 480;  // px, each image
  double rate = 20.0;                      // Hz, frames
  double latency = 0.050;                  // s, from exposure to the fingertip
  Lens left, right;
  Pose<'C', 'D'> X_CD = Pose<'C', 'D'>::shift(0.090, 0, 0);  // right camera in C

  [[nodiscard]] ImageSize size() const { return {static_cast<int>(width), static_cast<int>(height)}; }
};

// The tool tip that deforms the shown surface (seen_tool()).
enum class SeenTip : std::uint8_t {
  tracked,    // newest tracked pose, uncorrected for its age, as in the paper [VHMR 3.5]
  predicted,  // the haptic loop's prediction (TrackerRig::prediction)
  fused       // predicted; while it presses, by the haptic-tip's position
};
constexpr auto words(SeenTip) { return enum_words("tracked", "predicted", "fused"); }

// The display [VHMR 3.5].
struct DisplayRig {
  std::string driver = "sim";
  SeenTip tip = SeenTip::predicted;
  // `fused` only: time ahead of now, the mean age of a surface while it is seen, s; and the compliance of
  // tool and haptic-tip where they touch, m/N.
  double lead = 0.0, compliance = 0.0;
  double overdue = 0.200;       // s: an older surface causes a hold
  double margin = 0.0008;       // m: tracker and drawing error allowed between shown and rendered surface
  double margin_speed = 0.050;  // m/s: growth of that margin with the surface's age
};

// A tracker of the user's hand, for what is drawn of it [VHMR 3.2].
struct HandTrackerRig {
  std::string driver = "none";  // in a rig file without its table
};

}  // namespace enc
