// Recognises a tool by its markers and computes its pose [VHMR 3.2]. Markers look alike, so their distances
// identify the tool. Never allocates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/frames.h"

namespace enc {

inline constexpr std::size_t kFewestMarkers = 3;  // fewest that give a pose
inline constexpr std::size_t kMostMarkers = 16;

// Worst-case noise of a marker: rms, each axis. The distance between two markers then has a noise of 0.42 mm.
inline constexpr double kMarkerNoise = 0.3e-3;  // m

// Two distances that differ by less may be confused. With two candidates 4 mm apart, the nearer one is wrong
// if the error exceeds 2 mm, 4.7 times the noise of a distance. That happens about once in a million views,
// and only for tools that are barely distinguishable.
inline constexpr double kMarkersApart = 4e-3;  // m
// Worst accepted fit: rms over all markers. If the best-fitting tool fits worse, the markers belong to no
// tool. Distances alone are not enough: a mirror image has the same, and another tool's may all be off by
// almost 4 mm. Noise in n markers leaves 3n - 6 of 3n numbers to differ, an rms of sqrt(3 - 6 / n) times the
// noise. This limit is 5 times the noise: it refuses fewer than one view in 10^15 of three markers, and even
// fewer of more. One distance off by 4 mm costs 4 mm / sqrt(2 n), so three markers with such an error are
// refused. Noise of 1 mm loses a sixth of the views of four markers, noise of 2 mm nine of ten.
inline constexpr double kWorstFit = 5.0 * kMarkerNoise;  // m

struct RecognisedTool {
  std::int32_t tool = -1;  // index; -1: no tool fits
  Pose<'C', 'T'> X_CT;
  double rms = kUnset;  // m, of the measured markers against the tool's own
};
// `seen`: positions of one tool's markers in C, in any order, all present. `tools`: the markers of each tool,
// in T.
[[nodiscard]] RecognisedTool recognise(std::span<const Vec3> seen, std::span<const std::vector<Vec3>> tools);

// Mean of the markers, m; zero without markers.
[[nodiscard]] Vec3 middle_of(std::span<const Vec3> markers);
// Covariance of a point of the tool in T, m^2, for white noise of 1 m along each axis of at least
// kFewestMarkers markers: that of the least-squares pose, for small rotations.
[[nodiscard]] Mat3 point_covariance(std::span<const Vec3> markers, const Vec3& point);

// True if the markers of one tool can be confused with those of the other, in some order, by their distances.
// Mirror images can: handedness alone separates them too little.
[[nodiscard]] bool alike(std::span<const Vec3> markers, std::span<const Vec3> other);
// True if the markers can be confused with themselves in another order; the pose is then ambiguous.
[[nodiscard]] bool has_two_poses(std::span<const Vec3> markers);

}  // namespace enc
