// A tool by its markers: which of several it is, and how it stands [VHMR 3.2]. Markers look alike, so that
// their distances tell one from the other. Never allocates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/frames.h"

namespace enc {

inline constexpr std::size_t kMostMarkers = 16;

// Two distances that differ by less may be taken for each other. A marker is known to 0.3 mm at worst (rms,
// each axis), a distance of two to 0.42 mm. The nearer of two distances 4 mm apart is the wrong one where the
// error is above 2 mm, 4.7 times that: about once in a million looks, and only for tools that are just told
// apart.
inline constexpr double kMarkersApart = 4e-3;  // m

struct RecognisedTool {
  std::int32_t tool = -1;  // index; -1: none of them
  Pose<'C', 'T'> X_CT;
  double rms = kUnset;  // m, of what is seen to where the tool has it
};
// `seen`: places of one tool's markers in C, in any order, none missing. `tools`: of each its markers in T.
[[nodiscard]] RecognisedTool recognise(std::span<const Vec3> seen, std::span<const std::vector<Vec3>> tools);

// Whether the markers of one can be taken for those of the other, in some order, by their distances. Mirror
// images can: handedness alone is little to tell by.
[[nodiscard]] bool alike(std::span<const Vec3> markers, std::span<const Vec3> other);
// Whether they can be taken for themselves in another order: the pose is not known then.
[[nodiscard]] bool has_two_poses(std::span<const Vec3> markers);

}  // namespace enc
