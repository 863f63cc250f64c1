// The part of a tick that the display needs: the tools' poses and the mode.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "core/devices/mode.h"

namespace enc {

struct View {
  Time t{};
  std::int32_t tool = -1;    // index in the scene; -1: no tool seen
  std::int32_t object = -1;  // nearest object; -1: no object
  Pose<'W', 'T'> X_WT;       // the tool's markers, as tracked
  Point<'W'> tip;            // centre of the tool's tip
  Mode mode = Mode::away;
};

}  // namespace enc
