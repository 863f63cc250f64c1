// Decides which force a device exerts: the loop's, or zero. A watchdog of the loop, a dead man's switch, the
// device's errors and a ramp at each start. It uses neither clocks nor threads.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::arm {

// The loop's newest command.
struct ForceOrder {
  Vec<'R'> force = Vec<'R'>::zero();
  Duration given{};         // steady clock at the reading that it follows
  std::int64_t number = 0;  // 0: no command yet
  bool stopped = false;     // a stop came after it
};

struct GuardLimits {
  double watchdog = 0.003;  // s: an older command counts as none
  double rise = 20.0;       // N/s: growth of the largest allowed force after zero force; 0: no ramp
  double most = 8.5;        // N: the device's own limit
  double calm = 0.5;        // s without an error of the device, before it exerts force again
};

struct GuardCounts {
  std::int64_t watchdog = 0;  // times that the loop's commands ran out
  std::int64_t released = 0;  // times that the switch opened while a force was commanded
  std::int64_t clipped = 0;   // forces beyond the device's limit
};

class ForceGuard {
 public:
  explicit ForceGuard(const GuardLimits& limits) : limits_(limits) {}

  // Call in each period of the device. `pressed`: the dead man's switch is closed. `error`: the device
  // reports an error now.
  Vec<'R'> pass(Duration now, const ForceOrder& order, bool pressed, bool error) noexcept {
    if (error) erred_ = now, ever_erred_ = true;
    const bool commanded = order.number > 0 && !order.stopped;
    const bool fresh = commanded && seconds(now - order.given) <= limits_.watchdog;
    if (live_ && commanded && !fresh) ++counts_.watchdog;
    if (live_ && fresh && !pressed) ++counts_.released;
    live_ = fresh && pressed && !faulty(now);
    if (!live_) {
      since_ = now;
      begun_ = true;
      return Vec<'R'>::zero();
    }
    if (!begun_) since_ = now, begun_ = true;
    return limited(order.force, now);
  }

  // True from an error of the device until it was quiet for `calm`.
  [[nodiscard]] bool faulty(Duration now) const noexcept {
    return ever_erred_ && seconds(now - erred_) < limits_.calm;
  }
  [[nodiscard]] const GuardCounts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] Vec<'R'> limited(const Vec<'R'>& force, Duration now) noexcept {
    const double norm = force.norm();
    if (norm > limits_.most) ++counts_.clipped;
    double most = limits_.most;
    if (limits_.rise > 0.0) most = std::min(most, limits_.rise * seconds(now - since_));
    return norm > most ? (most / norm) * force : force;
  }

  GuardLimits limits_;
  GuardCounts counts_;
  Duration since_{}, erred_{};  // since_: the last zero force
  bool live_ = false, begun_ = false, ever_erred_ = false;
};

}  // namespace enc::arm
