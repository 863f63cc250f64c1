// What was asked of a run by somebody who steered it, and the ticks from which it holds. A record keeps it,
// and a later run plays it back (docs/reference/record.md, "hand").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trial/steered/hand_word.h"

namespace enc::trial {

class SteeringLog {
 public:
  void add(std::int64_t tick, const HandWord& word) { steps_.push_back({tick, word}); }
  [[nodiscard]] bool empty() const { return steps_.empty(); }
  // All up to `tick` that is new since the last call, or unset, as TrialOptions::steer wants it. Ticks must
  // ascend.
  [[nodiscard]] std::optional<HandWord> at(std::int64_t tick);

  // CSV with one line per step: tick, whether there is a place, the place in W, m, whether the tool is
  // changed, bits of the faults. Numbers are read back to the bit.
  [[nodiscard]] std::string text() const;
  // Reads the text of a record, which may be corrupt. Throws Error (kind input) with the line.
  static SteeringLog read(const std::string& text, const std::string& record);

 private:
  struct Step {
    std::int64_t tick = 0;
    HandWord word;
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
