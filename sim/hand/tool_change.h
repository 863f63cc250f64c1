// The change of tools of a hand that is steered: it carries its tool to the tray, lets go, and takes the
// other one. Meanwhile it does not go where it is told.
#pragma once

#include <cstdint>

#include "core/base/frames.h"

namespace enc::sim {

struct ToolChange {
  static constexpr double kSwap = 0.8;     // s with an empty hand, at least (as of a scripted change)
  static constexpr double kThere = 0.001;  // m from the place on the tray
  static constexpr double kRests = 0.02;   // m/s
  enum class Stage : std::uint8_t { none, away, empty };  // of the hand: away to the tray
  Stage stage = Stage::none;
  std::int32_t from = 0;  // the tool that is laid down: 0 the first, 1 the other
  double since = 0.0;     // s since the hand is empty
  Point<'W'> wanted;      // where the tip is wanted afterwards
};

}  // namespace enc::sim
