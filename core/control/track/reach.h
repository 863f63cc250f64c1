// Predicts where a reaching hand will touch, from a few pictures and a model of how people reach: a first
// movement that falls short or overshoots, and a second one that corrects it, each of minimum jerk [Woodworth
// 1899; Flash and Hogan 1985; Meyer et al. 1988]. Many such reaches, each with its best paths, are compared
// with the pictures. The prediction is their mean, weighted by fit. A hand at constant velocity is one of
// these reaches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/base/frames.h"
#include "core/spec/optics_rig.h"

namespace enc {

// Minimum-jerk motion, as people move between two points: from 0 to 1 in unit time [Flash and Hogan 1985].
struct MinimumJerk {
  double x, v, a;  // position, velocity, acceleration
  constexpr explicit MinimumJerk(double s) {
    s = std::clamp(s, 0.0, 1.0);
    x = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    v = 30.0 * s * s * (1.0 - s) * (1.0 - s);
    a = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
  }
};

// A fingertip in one picture, m, in axes whose z is the surface's normal; z = 0 where the tip touches.
struct Sighting {
  Vec3 at{kUnset, kUnset, kUnset};
  double age = kUnset;  // s since exposure
};
inline constexpr std::size_t kSightings = 5;  // more pictures do not help

// The place of a touch at an assumed time, and how well that time fits the pictures.
struct Touch {
  Eigen::Vector2d place{kUnset,
                        // x and y; unset: fewer than three pictures, or the finger does not approach.
                        kUnset};
  // Logarithm of the density of that time, per s, without the part that all times share.
  double evidence = kUnset;
};
// Ages hold at the assumed time. `noise`: of a picture, m rms. `carried`: position at that time of a hand at
// constant velocity, from all data; unset: from these few pictures.
[[nodiscard]] Touch touch_then(const ReachBelief& hand, std::span<const Sighting> newest_first, double noise,
                               const Eigen::Vector2d& carried = {kUnset, kUnset}) noexcept;

// Fit of the pictures to a finger at constant velocity that has not reached the surface by `until`, s from
// the time of the ages: logarithm of a probability, without the part that touch_then() leaves out too.
// -infinity: too few pictures, or no sound one.
[[nodiscard]] double passes_by(std::span<const Sighting> newest_first, double noise, double until) noexcept;

}  // namespace enc
