// The steering of the twin's hand in a run: places and the ticks from which they hold. A record keeps it, and
// a later run plays it back (docs/reference/record.md, "hand").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"

namespace enc::trial {

class SteeringLog {
 public:
  void add(std::int64_t tick, const Point<'W'>& place) { steps_.push_back({tick, place}); }
  [[nodiscard]] bool empty() const { return steps_.empty(); }
  // The newest place up to `tick`, or unset without news, as TrialOptions::steer wants it. Ticks must ascend.
  [[nodiscard]] std::optional<Point<'W'>> at(std::int64_t tick);

  // CSV with one line per step: tick and place in W, m. Numbers are read back to the bit.
  [[nodiscard]] std::string text() const;
  // Reads the text of a record, which may be corrupt. Throws Error (kind input) with the line.
  static SteeringLog read(const std::string& text, const std::string& record);

 private:
  struct Step {
    std::int64_t tick = 0;
    Point<'W'> place;
  };
  std::vector<Step> steps_;
  std::size_t next_ = 0;
};

// The steering in a record, and how long that run took.
struct SteeredRun {
  SteeringLog log;
  double duration = 0.0, period = 0.0;  // s: of the run, and of its ticks
  std::string seed;
};
// Throws Error (kind input) for a file that is not a record, or a record without steering.
[[nodiscard]] SteeredRun steered_run(const std::string& record);

}  // namespace enc::trial
