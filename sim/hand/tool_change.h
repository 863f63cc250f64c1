// The change of tools by a steered hand: it carries its tool to the tray, releases it, and takes the other
// one. Meanwhile it ignores its steering.
#pragma once

#include <cstdint>

#include "core/base/frames.h"

namespace enc::sim {

struct ToolChange {
  static constexpr double kSwap = 0.8;     // s with an empty hand, at least (as in a scripted change)
  static constexpr double kThere = 0.001;  // m from the place on the tray
  static constexpr double kRests = 0.02;   // m/s
  // State of the hand; away: on the way to the tray.
  enum class Stage : std::uint8_t { none, away, empty };
  Stage stage = Stage::none;
  std::int32_t from = 0;  // the released tool: 0 the first, 1 the other
  double since = 0.0;     // s since the hand became empty
  Point<'W'> wanted;      // target of the tip afterwards
};

}  // namespace enc::sim
