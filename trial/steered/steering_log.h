// The requests of a steered run, with the ticks from which they hold. A record keeps them, and a later run
// plays them back (docs/reference/record.md, "hand").
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
  // All new requests since the last call up to `tick`, or unset, as TrialOptions::steer expects. Ticks must
  // ascend.
  [[nodiscard]] std::optional<HandWord> at(std::int64_t tick);

  // CSV with one line for each step: tick, whether there is a place, the place in W, m, whether the tool is
  // changed, bits of the faults. Numbers read back to the bit.
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

// The steering in a record, and the duration of that run.
struct SteeredRun {
  SteeringLog log;
  double duration = 0.0, period = 0.0;  // s: length of the run, and of its ticks
  std::string seed;
};
// Throws Error (kind input) for a file that is not a record, or a record without steering.
[[nodiscard]] SteeredRun steered_run(const std::string& record);

}  // namespace enc::trial
