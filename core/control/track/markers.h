// A tool by its markers: which of several it is, and how it stands [VHMR 3.2]. Markers look alike, so that
// their distances tell one from the other. Never allocates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/frames.h"

namespace enc {

inline constexpr std::size_t kFewestMarkers = 3;  // of a tool whose pose they give
inline constexpr std::size_t kMostMarkers = 16;

// What a marker is known to at worst: rms, each axis. A distance of two is known to 0.42 mm.
inline constexpr double kMarkerNoise = 0.3e-3;  // m

// Two distances that differ by less may be taken for each other. The nearer of two distances 4 mm apart is
// the wrong one where the error is above 2 mm, 4.7 times that of a distance: about once in a million looks,
// and only for tools that are just told apart.
inline constexpr double kMarkersApart = 4e-3;  // m
// What is seen is none of the tools where the one that fits best fits worse: rms of all markers. Distances
// alone do not tell: a mirror image has the same, and of another tool all may be off by almost 4 mm. Noise
// leaves 3n - 6 of the 3n numbers of n markers to differ, an rms of sqrt(3 - 6 / n) of itself. This is 5
// times the noise: of three markers it refuses fewer than one look in 10^15, of more yet fewer. One distance
// that is off by 4 mm costs 4 mm / sqrt(2 n), so that of three markers it is refused. Noise of 1 mm loses a
// sixth of the looks at four markers by it, noise of 2 mm nine of ten.
inline constexpr double kWorstFit = 5.0 * kMarkerNoise;  // m

struct RecognisedTool {
  std::int32_t tool = -1;  // index; -1: none of them
  Pose<'C', 'T'> X_CT;
  double rms = kUnset;  // m, of what is seen to where the tool has it
};
// `seen`: places of one tool's markers in C, in any order, none missing. `tools`: of each its markers in T.
[[nodiscard]] RecognisedTool recognise(std::span<const Vec3> seen, std::span<const std::vector<Vec3>> tools);

// Their mean, m; zero without markers.
[[nodiscard]] Vec3 middle_of(std::span<const Vec3> markers);
// Covariance of a point of the tool, in T, m^2, when each of at least kFewestMarkers markers has white noise
// of 1 m along each axis: of the least-squares pose, for small turns.
[[nodiscard]] Mat3 point_covariance(std::span<const Vec3> markers, const Vec3& point);

// Whether the markers of one can be taken for those of the other, in some order, by their distances. Mirror
// images can: handedness alone is little to tell by.
[[nodiscard]] bool alike(std::span<const Vec3> markers, std::span<const Vec3> other);
// Whether they can be taken for themselves in another order: the pose is not known then.
[[nodiscard]] bool has_two_poses(std::span<const Vec3> markers);

}  // namespace enc
