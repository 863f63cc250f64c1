// A constant-velocity Kalman filter on (column, row, disparity). Noise there is independent of the finger's
// position; in metres it grows with the square of the depth [VisHap 2.1.2; Bar-Shalom 6.2].
#pragma once

#include <array>

#include "core/base/time.h"
#include "core/spec/vision_rig.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

class TripletFilter {
 public:
  void forget() { known_ = false; }
  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] Time t() const { return t_; }

  void begin(const TrackSpec& spec, Time t, const Triplet& at, const Vec3& variance);
  // Predicts to a later time.
  void predict(const TrackSpec& spec, Time t);
  // Squared distance of a detection from the prediction, in sigmas; of three numbers.
  [[nodiscard]] double surprise(const Triplet& at, const Vec3& variance) const;
  void correct(const Triplet& at, const Vec3& variance);

  [[nodiscard]] Triplet at() const { return {axes_[0].x, axes_[1].x, axes_[2].x}; }
  [[nodiscard]] Triplet rate() const { return {axes_[0].v, axes_[1].v, axes_[2].v}; }
  [[nodiscard]] Vec3 variance() const { return {axes_[0].xx, axes_[1].xx, axes_[2].xx}; }

 private:
  struct Axis {
    double x = 0.0, v = 0.0, xx = 0.0, xv = 0.0, vv = 0.0;
  };
  std::array<Axis, 3> axes_;
  Time t_{};
  bool known_ = false;
};

}  // namespace enc
