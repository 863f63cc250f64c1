// A run of a shipped scene as `run` has it, whose ticks are counted in a process of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/hygiene/tally.h"
#include "trial/trial.h"

namespace enc::test {

// A tally that a process of its own has made: a filter of system calls can never be removed.
struct Told {
  Tally tally;
  double extra = 0.0;  // as the child said
  std::string error;   // empty: it came to its end
};
// What `work` tells, in a child of this process. Of one thread: the others are not in the child.
[[nodiscard]] Told in_child(const std::function<void(Told&)>& work);

// "2 heap, 1 lock in 60000 ticks", and who made the first: a line for each.
[[nodiscard]] std::string words(const Tally& tally);

inline constexpr std::int64_t kWarmUp = 100;    // ticks
inline constexpr std::int64_t kTicks = 60'000;  // of each scene
inline constexpr const char* kNoFilter = "no filter of system calls (seccomp) here: they were NOT counted";

// Names below models/scenes: "plane"; or those with a camera: "camera/wall".
[[nodiscard]] std::vector<std::string> scenes(bool camera);

struct Case {
  std::string scene = "plane";
  trial::TrialOptions options{};  // its watch() comes after the measures of `run`
  std::string record{};           // a file; empty: none
  std::int64_t most = INT64_MAX;  // ticks, beside those of the warm-up; or until its programme is over
};

// From the end of its warm-up on, in a process of its own. `extra`: pictures that came; or bytes of the
// record.
[[nodiscard]] Told counted_run(const Case& asked);
// Page faults that come once are the machine's, which may take a page from anybody at any time; what is the
// program's own comes again.
[[nodiscard]] Told without_chance(const Case& asked);
// Run after run, with seed after seed: the first to the end of its programme, all together at least kTicks.
// Each is cold: its first contact is counted, too. Stops where `good` does not hold.
void count_scene(const Case& asked, const std::function<void(const Told&)>& good);

class Tick : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override;
};
using AnyTick = Tick;

}  // namespace enc::test
