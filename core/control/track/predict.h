// Predicts the present position of the tracked tool's tip. Poses arrive late, so the tip's motion is filtered
// and extrapolated: a Kalman filter on the tip's position in W, at the exposure stamps [sources/tracking 4].
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

// The filter's state at the newest exposure. A stereo camera measures a position less accurately along its
// view from C than across it, so there are two covariances; all directions across share one. For a tracker
// that measures every direction alike, both are equal. If the view turns while the hand moves, the covariance
// turns with it.
struct TipMotion {
  std::int32_t tool = -1;  // -1: no estimate
  Time t{};
  Point<'W'> position;
  Vec<'W'> velocity, acceleration;
  AxisDoubt along, across;
};

// Standard uncertainty of a pose's position, m rms.
struct TipNoise {
  double along = kUnset, across = kUnset;
  Vec<'W'> view = Vec<'W'>::zero();  // unit; zero: no direction is special
  [[nodiscard]] double mean_square() const { return (along * along + 2.0 * across * across) / 3.0; }
};
// The noise that the pose reports, else that of the rig file.
[[nodiscard]] TipNoise noise_of(const TrackerRig& rig, const TrackedTool& pose,
                                const Pose<'W', 'C'>& X_WC) noexcept;

// Exposure time of a pose with this stamp, by the rig file's latency.
[[nodiscard]] inline Time exposed(const TrackerRig& rig, Time stamp) {
  return stamp - from_seconds(rig.stamp_late);
}

// Adds the tip's position, exposed at `t` (later than all before), with its noise. After a drop-out the
// estimate jumps to the data at once: safety reads it, and only the command is smoothed (sources/choices 13).
// `calm`: the tip lies on something, so an apparent jump is noise.
void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, const TipNoise& noise,
             TipMotion& motion, bool calm = false) noexcept;

// Corrects the prediction for `now` by `off`, its error along one direction as measured by something much
// more accurate than a picture. The covariance splits the error between position and velocity. The covariance
// itself stays, because this is not a picture and the correction is repeated in each tick.
void correct_now(const TrackerRig& rig, Time now, const Vec<'W'>& off, TipMotion& motion) noexcept;

// Tip position at `now`.
[[nodiscard]] Point<'W'> predict(const TrackerRig& rig, const TipMotion& motion, Time now) noexcept;

}  // namespace enc
