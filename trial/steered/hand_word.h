// What somebody who steers a run of the twin asks for at a tick.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/frames.h"

namespace enc::trial {

struct HandWord {
  std::optional<Point<'W'>> place{};  // wanted place of the tip of the tool; unset: no news
  bool changes_tool = false;          // the hand lays its tool down and takes the other one
  std::uint8_t faults = 0;            // bits of Fault (faults.h), from here on
};

}  // namespace enc::trial
