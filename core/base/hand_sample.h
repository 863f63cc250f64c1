// A hand as a hand tracker reports it, for what is drawn of it [VHMR 3.2].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/frames.h"

namespace enc {

enum class HandSide : std::uint8_t { left, right };

// The wrist, then of thumb, index, middle, ring and little finger four each, the tip last.
inline constexpr std::size_t kHandJoints = 21;
inline constexpr std::size_t kIndexTip = 8;

struct HandSample {
  HandSide side = HandSide::right;
  Pose<'L', 'K'> wrist;
  std::array<Point<'L'>, kHandJoints> joints;
  double skin = kUnset;  // thickness from a joint to the skin, m
};

}  // namespace enc
