// The reaction of a run to a fault of one device, and its bounds.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "core/base/sample.h"
#include "core/devices/mode.h"

namespace enc::bench::devices {

// Outcome of a run.
enum class End : std::uint8_t {
  unharmed,  // does not hold
  holds,     // holds while the fault lasts, then goes on
  link_lost  // holds, and needs a new run
};

inline constexpr double kNever = std::numeric_limits<double>::infinity();

// Times in ms from the fault.
struct Reaction {
  Mode in = Mode::hold;                 // mode at the injection
  double hold = kNever, zero = kNever;  // until the run holds, and until the arm has no force from then on
  std::uint32_t why = 0;                // reason of the first hold
  bool linked = true;                   // at the end
  bool goes_on = false;                 // the run was in another mode than hold after the cure
  std::string said{};                   // the driver's messages
};

// The bounds of a fault.
struct Limits {
  End end = End::link_lost;
  double hold = 0.0, zero = kNever;  // ms, at most
  std::uint32_t why = 0;             // one of the reasons
};

// Lists the bounds that the reaction violates; empty if it meets all. In a run that holds already (`mode` is
// hold) the fault adds no hold.
[[nodiscard]] std::string wrong_with(const Limits& limits, Mode mode, const Reaction& of);

// A false report of a device to the core: it hides a fault, or feigns one where no hold is expected. A row of
// a matrix that can fail fails for it.
template <class Sample>
class FalseReport {
 public:
  // `faulty`: the fault lasts. Changes the device's sample, and the number of missed cycles.
  void give(bool faulty, End expected, Time now, Measurement<Sample>& said, std::int64_t& missed) {
    if (!faulty) {
      last_ = said;
    } else if (expected == End::unharmed) {
      said.health = Health::fault;
    } else {
      said = {last_.value, now, Health::ok};
      missed = 0;
    }
  }

 private:
  Measurement<Sample> last_;
};

}  // namespace enc::bench::devices
