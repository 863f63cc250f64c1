// Search for a block of the left image in the right one: a part of the rig table [vision].
#pragma once

#include <cstdint>

namespace enc {

struct MatchSpec {
  // px, size of the block: as small as a thin finger far off, or the block sees more of the background.
  // Columns 8, 12 or 16; rows odd and at most 15.
  int columns = 8, rows = 7;
  double nearest = 0.25;  // m, nearest matched distance
  double farthest = 1.5;  // m, farthest matched distance
  // Least extra cost of the next best position, three or more pixels off, as a share; otherwise the match is
  // ambiguous.
  double uniqueness = 0.10;
  double agreement = 1.5;  // px: check from the right image back to the left; negative: no check
};

}  // namespace enc
