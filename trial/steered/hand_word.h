// Request at a tick from the person who steers the twin's hand.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/frames.h"

namespace enc::trial {

struct HandWord {
  std::optional<Point<'W'>> place{};  // requested place of the tool's tip; unset: no change
  // The hand lays its tool down and takes the other one.
  bool changes_tool = false;
  std::uint8_t faults = 0;  // bits of Fault (faults.h), from here on
};

}  // namespace enc::trial
