// A controller that was inspected and is ready for commands: the common part of the drivers that talk to it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/devices/driver.h"
#include "core/machine/servo.h"
#include "hw_drivers/gcs/drive/inspect.h"
#include "hw_drivers/gcs/drive/link.h"

namespace enc::gcs {

// Motion of the machine under its set-points, by the rig file's servo model. GCS reports only positions, and
// differencing them twice gives only noise.
class BelievedServo {
 public:
  static constexpr std::int64_t kLongest = 64;  // most cycles of delay
  // Delay and period: s. Step: quantisation, m; 0: no quantisation. Steps are counted from `zero`, the
  // machine's zero.
  BelievedServo(const ServoLaw& law, double delay, double period, double step, const Vec3& zero)
      : law_(law), period_(period), step_(step), zero_(zero) {
    delay_ = std::min(std::llround(delay / period), static_cast<long long>(kLongest - 1));
  }

  // Advances by one period under this set-point, which comes one period after the last one.
  void next(const Vec3& point) noexcept {
    line_[static_cast<std::size_t>(given_ % kLongest)] = point;
    const std::int64_t due = std::max<std::int64_t>(0, given_ - delay_);
    ++given_;
    const Vec3 wanted = zero_ + in_steps(line_[static_cast<std::size_t>(due % kLongest)] - zero_, step_);
    follow(law_, wanted, period_, motion_);
  }
  // Sets the machine to rest at this position; the next set-point begins anew.
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

// A command in the machine's coordinates.
struct Aim {
  Pose<'R', 'H'> X_RH;
  Coordinates to{};
  // Fault: not a number, or not a rotation; such a command is not sent.
  Health health = Health::ok;
};

class ControllerDriver {
 public:
  // Throws Error (kind device) as inspect() does.
  ControllerDriver(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] const GcsSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const ControllerInfo& found() const noexcept { return found_; }
  [[nodiscard]] const Reach& reach() const noexcept { return reach_; }
  [[nodiscard]] const Pose<'R', 'H'>& at_first() const noexcept { return at_first_; }  // pose at the start
  [[nodiscard]] Link& link() noexcept { return *link_; }
  [[nodiscard]] const Link& link() const noexcept { return *link_; }
  [[nodiscard]] std::string describe() const;
  void say(const std::string& words) const { log_.say(describe() + words); }

  // A set-point for the coming period, limited to the struts and to the controller's range on each axis.
  const Aim& aim(const Pose<'R', 'H'>& X_RH) noexcept;
  void stand() noexcept { servo_.stand(aim_.X_RH.p()); }
  [[nodiscard]] const Aim& aim() const noexcept { return aim_; }
  // Acceleration of the tip under the set-points so far.
  [[nodiscard]] Vec<'R'> acceleration() const noexcept { return Vec<'R'>(servo_.motion().acceleration); }

 private:
  GcsSettings settings_;
  Log& log_;
  std::unique_ptr<Link> link_;
  ControllerInfo found_;
  Reach reach_;
  Pose<'R', 'H'> at_first_;
  Aim aim_;
  BelievedServo servo_;
};

// Sends a line and waits for the whole answer, before the run. Throws Error (kind device) if no answer comes.
[[nodiscard]] std::string ask(Link& link, const GcsSettings& settings, std::string_view line);

}  // namespace enc::gcs
