// The hooks with which the window of `encounter view`, or the client of `encounter serve`, watches and steers
// a run. All are called on the run's thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "app/common/options.h"
#include "trial/trial.h"

namespace enc::app {

struct RunWindow {
  bool draws = true;                             // also builds parts that are only drawn
  std::function<void(models::Setup&)> adapts{};  // changes the setup before anything is built
  // Called before the first tick, unless the run is refused.
  std::function<void(trial::Trial&)> begins{};
  // Called once after begins(), however the run ended. The trial is destroyed afterwards.
  std::function<void()> ends{};
  std::function<void(const trial::Glance&)> watch{};            // after each tick; it must not block
  std::function<void(const Measurement<StereoFrame>&)> look{};  // see TrialOptions::look
  std::function<bool()> stop{};
  std::function<bool()> waits{};  // true: the next tick is not due; the hook may sleep briefly
  std::function<trial::Hand()> hand{};
  std::function<std::optional<trial::HandWord>(std::int64_t)> steer{};  // see TrialOptions::steer
};

// Runs `encounter run` with hooks; null: without hooks.
int run(const RunOptions& options, const RunWindow* window);

}  // namespace enc::app
