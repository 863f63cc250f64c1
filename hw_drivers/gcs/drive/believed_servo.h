// Motion of the machine under its set-points, by the rig file's servo model. GCS reports only positions, and
// differencing them twice gives only noise.
#pragma once

#include <array>
#include <cstdint>

#include "core/machine/servo.h"

namespace enc::gcs {

class BelievedServo {
 public:
  static constexpr std::int64_t kLongest = 64;  // most cycles of delay
  // Delay and period: s. Step: quantisation, m, 0: no quantisation. Steps are counted from `zero`, the
  // machine's zero.
  BelievedServo(const ServoLaw& law, double delay, double period, double step, const Vec3& zero)
      : law_(law), period_(period), step_(step), zero_(zero) {
    delay_ = std::min(std::llround(delay / period), static_cast<long long>(kLongest - 1));
  }

  // One period under this set-point, which comes a period after the last one.
  void next(const Vec3& point) noexcept {
    line_[static_cast<std::size_t>(given_ % kLongest)] = point;
    const std::int64_t due = std::max<std::int64_t>(0, given_ - delay_);
    ++given_;
    const Vec3 wanted = zero_ + in_steps(line_[static_cast<std::size_t>(due % kLongest)] - zero_, step_);
    follow(law_, wanted, period_, motion_);
  }
  // The machine stands at this position; the next set-point begins anew.
  void stand(const Vec3& at) noexcept {
    given_ = 0;
    motion_ = {at};
  }
  [[nodiscard]] const ServoMotion& motion() const noexcept { return motion_; }

 private:
  ServoLaw law_;
  double period_, step_;
  Vec3 zero_;
  std::int64_t delay_ = 0, given_ = 0;
  std::array<Vec3, kLongest> line_{};
  ServoMotion motion_;
};

}  // namespace enc::gcs
