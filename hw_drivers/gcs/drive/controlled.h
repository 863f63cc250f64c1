// A controller that was inspected and is ready for commands: the common part of the drivers that talk to it.
#pragma once

#include <memory>
#include <string>

#include "core/devices/driver.h"
#include "hw_drivers/gcs/drive/believed_servo.h"
#include "hw_drivers/gcs/drive/inspect.h"
#include "hw_drivers/gcs/drive/link.h"

namespace enc::gcs {

// A command in the machine's coordinates.
struct Aim {
  Pose<'R', 'H'> X_RH;
  Coordinates to{};
  // Fault: not a number, or not a rotation; such a command is not sent.
  Health health = Health::ok;
};

class Controlled {
 public:
  // Throws Error (kind device) as inspect() does.
  Controlled(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] const GcsSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Found& found() const noexcept { return found_; }
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
  Found found_;
  Reach reach_;
  Pose<'R', 'H'> at_first_;
  Aim aim_;
  BelievedServo servo_;
};

// Sends a line and waits for the whole answer, before the run. Throws Error (kind device) if no answer comes.
[[nodiscard]] std::string ask(Link& link, const GcsSettings& settings, std::string_view line);

}  // namespace enc::gcs
