// Experiment time. It deliberately has no now(): time is an argument, and only a Clock makes it
// [sources/choices 2].
#pragma once

#include <chrono>
#include <cstdint>

namespace enc {

// The experiment's own clock: integer nanoseconds since its first tick.
struct Epoch {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<Epoch>;
  static constexpr bool is_steady = true;
};
using Time = Epoch::time_point;
using Duration = Epoch::duration;

// One cycle of the haptic loop: its number, its time and its length.
struct Tick {
  std::int64_t index = 0;
  Time t{};
  Duration dt{1'000'000};
};

[[nodiscard]] constexpr double seconds(Duration d) { return static_cast<double>(d.count()) / 1e9; }
// Age at `now` of something stamped `then`, s. Computed in double, so that no stamp overflows, however wrong.
[[nodiscard]] constexpr double age(Time now, Time then) {
  return (static_cast<double>(now.time_since_epoch().count()) -
          static_cast<double>(then.time_since_epoch().count())) /
         1e9;
}
[[nodiscard]] constexpr Duration from_seconds(double s) {
  return Duration(static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

// Due times of a rate. Due time n is n * 1e9 / hz, never a running sum, so that a rate such as 120 Hz does
// not drift.
struct DueTimes {
  double hz = 0.0;
  std::int64_t n = 0;  // number of the next due time
  Duration phase{};    // offset of due time 0
  [[nodiscard]] Time next() const {
    return Time(phase + Duration(static_cast<std::int64_t>(static_cast<double>(n) * 1e9 / hz + 0.5)));
  }
  // Returns true if a due time has come, and consumes it. Call it until it returns false.
  bool due(Time t) {
    if (hz <= 0.0 || t < next()) return false;
    ++n;
    return true;
  }
};

}  // namespace enc
