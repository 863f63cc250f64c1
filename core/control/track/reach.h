// Where a reaching hand will touch, out of a few pictures of it and of how people reach: a first movement
// that falls short or shoots over, and a second one that corrects it, each of minimum jerk [Woodworth 1899;
// Flash and Hogan 1985; Meyer et al. 1988]. Many such reaches are held against the pictures, each with its
// best ways; their mean, weighted by how well they fit, is the place. A hand that comes with an even speed is
// one of them.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/frames.h"
#include "core/spec/tracker_rig.h"

namespace enc {

// The tip of a finger in one picture, in axes whose z is the surface's normal, 0 where the tip touches, m.
struct Sighting {
  Vec3 at{kUnset, kUnset, kUnset};
  double age = kUnset;  // s, since its exposure
};
inline constexpr std::size_t kSightings = 5;  // as many pictures are of use

// Where the tip touches if it touches at a time, and how well that time fits the pictures.
struct Touch {
  Eigen::Vector2d place{kUnset,
                        kUnset};  // x and y; unset: fewer than three pictures, or it does not come nearer
  double evidence = kUnset;       // logarithm of a density of that time, per s; but for what all times share
};
// Ages are those at that time. `noise`: of a picture, m rms. `carried`: where a hand that goes on with an
// even speed is at that time, by all that is known of it; unset: these few say it.
[[nodiscard]] Touch touch_then(const ReachBelief& hand, std::span<const Sighting> newest_first, double noise,
                               const Eigen::Vector2d& carried = {kUnset, kUnset}) noexcept;

// How well the pictures fit a finger that goes on with an even speed and has not come to the surface by then,
// s from the time at which the ages hold: logarithm of a probability, but for what touch_then() leaves out,
// too. -infinity: there are too few pictures, or none is sound.
[[nodiscard]] double passes_by(std::span<const Sighting> newest_first, double noise, double until) noexcept;

}  // namespace enc
