// Where the tracked tool's tip is now: its poses are old when they come, so the tip's way is filtered and
// extrapolated. Kalman filter on the tip's position in W, taken at the exposure stamps [sources/tracking 4].
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/time.h"
#include "core/spec/rig_spec.h"

namespace enc {

// Covariance of position, velocity and acceleration along an axis, m, s.
struct AxisDoubt {
  double xx = 0.0, xv = 0.0, xa = 0.0, vv = 0.0, va = 0.0, aa = 0.0;
};

// What the filter knows of the tip at the newest exposure. A stereo camera knows a place less well along its
// view from C than to the sides of it, so there are two covariances; all sides have the same. Where a tracker
// knows all ways alike, both are equal. A view that turns while the hand moves takes its covariance with it.
struct TipMotion {
  std::int32_t tool = -1;  // -1: nothing is known
  Time t{};
  Point<'W'> position;
  Vec<'W'> velocity, acceleration;
  AxisDoubt along, across;
};

// How well a pose's place is known, m rms.
struct TipNoise {
  double along = kUnset, across = kUnset;
  Vec<'W'> view = Vec<'W'>::zero();  // unit; zero: no way is special
  [[nodiscard]] double mean_square() const { return (along * along + 2.0 * across * across) / 3.0; }
};
// As the pose says, or else as the rig believes.
[[nodiscard]] TipNoise noise_of(const TrackerRig& rig, const TrackedTool& pose,
                                const Pose<'W', 'C'>& X_WC) noexcept;

// When a pose with this stamp was exposed, as the rig believes.
[[nodiscard]] inline Time exposed(const TrackerRig& rig, Time stamp) {
  return stamp - from_seconds(rig.stamp_late);
}

// Takes in the tip's position, exposed at `t`, which is later than any before, and known so well. After a
// drop-out the belief is at once where the data are: safety reads it, and it is the command that is smoothed
// (sources/choices 13). `calm`: the tip lies on something, so that what looks like a surprise is noise.
void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, const TipNoise& noise,
             TipMotion& motion, bool calm = false) noexcept;

// Something that knows it far better than a picture says how far off the tip is `now` from where it is
// predicted, along one way. How much of that the place explains, and how much the velocity, their covariance
// says. It stays as it is: this is no picture, and it is said anew in each tick.
void correct_now(const TrackerRig& rig, Time now, const Vec<'W'>& off, TipMotion& motion) noexcept;

// Where the tip is `now`.
[[nodiscard]] Point<'W'> predict(const TrackerRig& rig, const TipMotion& motion, Time now) noexcept;

}  // namespace enc
