// How a block of the left image is sought in the right one: a part of the rig table [vision].
#pragma once

#include <cstdint>

namespace enc {

struct MatchSpec {
  // px, of the block: as small as a thin finger far off, or the block sees more of what is behind it. Columns
  // 8, 12 or 16, rows odd and at most 15.
  int columns = 8, rows = 7;
  double nearest = 0.25;  // m, of what is matched
  double farthest = 1.5;  // m
  // The next best place, three or more pixels off, has to cost more by this share, or nothing tells them
  // apart.
  double uniqueness = 0.10;
  double agreement = 1.5;  // px: back from the right image to the left one; negative: not asked
};

}  // namespace enc
