// The jaws as two sensors and the last command show them. The gripper measures neither opening nor force.
#pragma once

#include "core/base/sample.h"
#include "hw_drivers/gripper/drive/settings.h"

namespace enc::gripper {

struct Sensors {
  bool open = false;     // the jaws are open
  bool gripped = false;  // the jaws are where they grip the tool
};

// What the outputs drive.
enum class Drive : std::uint8_t { none, open, close };

class Jaws {
 public:
  explicit Jaws(const GripperSettings& settings) : settings_(settings) {}
  // The outputs changed.
  void drive(Drive drive, Duration now) noexcept;
  void take(const Sensors& sensors, Duration now) noexcept;
  [[nodiscard]] const GripSample& sample() const noexcept { return sample_; }
  // Both sensors at once, or jaws that do not leave or reach their end in time.
  [[nodiscard]] bool stuck() const noexcept { return stuck_; }

 private:
  GripperSettings settings_;
  GripSample sample_{.phase = GripPhase::opening, .opening = 0.0};
  Drive drive_ = Drive::none;
  Duration since_{};     // since drive_
  double before_ = 0.0;  // m, opening at since_
  bool stuck_ = false;
};

}  // namespace enc::gripper
