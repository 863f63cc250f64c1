// A run of a shipped scene like that of `run`, whose ticks are counted in a process of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/hygiene/tally.h"
#include "trial/trial.h"

namespace enc::test {

// A tally from a child process: a process cannot remove a filter of system calls.
struct ChildTally {
  Tally tally;
  double extra = 0.0;  // value from the child
  std::string error;   // empty: no error
};
// Runs `work` in a child of this process and returns its result. The child has one thread only.
[[nodiscard]] ChildTally in_child(const std::function<void(ChildTally&)>& work);

// "2 heap, 1 lock in 60000 ticks", then a line for each kind with its first caller.
[[nodiscard]] std::string words(const Tally& tally);

inline constexpr std::int64_t kWarmUp = 100;    // ticks
inline constexpr std::int64_t kTicks = 60'000;  // per scene
inline constexpr const char* kNoFilter = "no filter of system calls (seccomp) here: they were NOT counted";

// Names below models/scenes: "plane"; or those with a camera: "camera/wall".
[[nodiscard]] std::vector<std::string> scenes(bool camera);

struct Case {
  std::string scene = "plane";
  trial::TrialOptions options{};  // its watch() runs after the measurements of `run`
  std::string record{};           // a file; empty: no record
  std::int64_t most = INT64_MAX;  // ticks after the warm-up; or until the programme is over
};

// Counts from the end of the warm-up in a process of its own. `extra`: number of pictures, or bytes of the
// record.
[[nodiscard]] ChildTally counted_run(const Case& asked);
// Counts up to three times while page faults are the only calls. The machine may take a page from any process
// once; the program's own faults repeat.
[[nodiscard]] ChildTally without_chance(const Case& asked);
// Repeats runs with consecutive seeds: the first to the end of its programme, all together at least kTicks.
// Each is cold, so its first contact counts, too. Stops if `good` fails.
void count_scene(const Case& asked, const std::function<void(const ChildTally&)>& good);

class Tick : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override;
};
using AnyTick = Tick;

}  // namespace enc::test
