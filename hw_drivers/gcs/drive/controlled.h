// A controller that was asked and is ready to be told: what the ways to talk to it have in common.
#pragma once

#include <memory>
#include <string>

#include "core/devices/driver.h"
#include "hw_drivers/gcs/drive/believed_servo.h"
#include "hw_drivers/gcs/drive/inspect.h"
#include "hw_drivers/gcs/drive/link.h"

namespace enc::gcs {

// An aim as the machine can take it.
struct Aim {
  Pose<'R', 'H'> X_RH;
  Coordinates to{};
  Health health = Health::ok;  // fault: not a number, or no rotation, and nothing is to be sent
};

class Controlled {
 public:
  // Throws Error (kind device) as inspect() does.
  Controlled(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] const GcsSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const Found& found() const noexcept { return found_; }
  [[nodiscard]] const Reach& reach() const noexcept { return reach_; }
  [[nodiscard]] const Pose<'R', 'H'>& at_first() const noexcept { return at_first_; }  // where it stood
  [[nodiscard]] Link& link() noexcept { return *link_; }
  [[nodiscard]] const Link& link() const noexcept { return *link_; }
  [[nodiscard]] std::string describe() const;
  void say(const std::string& words) const { log_.say(describe() + words); }

  // A set-point for the coming period, within the struts and within what the controller takes on each axis.
  const Aim& aim(const Pose<'R', 'H'>& X_RH) noexcept;
  void stand() noexcept { servo_.stand(aim_.X_RH.p()); }
  [[nodiscard]] const Aim& aim() const noexcept { return aim_; }
  // Of the tip, under the set-points so far.
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

// Sends a line and waits for the whole answer, before the run. Throws Error (kind device) where none comes.
[[nodiscard]] std::string ask(Link& link, const GcsSettings& settings, std::string_view line);

}  // namespace enc::gcs
