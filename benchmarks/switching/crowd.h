// Many objects in one scene, to test and time the choice of the nearest one.
#pragma once

#include <cstdint>

#include "benchmarks/kit/entry.h"
#include "core/control/scene/scene.h"

namespace enc::bench::switching {

inline constexpr double kCrowdRoom = 0.3;  // m: half the side of the cube that they stand in

// Replaces the scene's objects by `count` others of four kinds: spheres, buttons, small meshes, and one in
// fifty a plane that closes the cube. All are drawn from the seed; they may overlap.
void fill_with_crowd(Scene& scene, std::size_t count, std::uint64_t seed);

// The nearest object by testing each, without bounds; the first of several that are equally near.
struct NearestObject {
  std::int32_t object = -1;
  double distance = kUnset;
  double next = kUnset;  // distance of the second nearest
};
[[nodiscard]] NearestObject brute_force(const Scene& scene, const Point<'W'>& p);

// The nearest object for an arm's finger of this radius: first of all those that it touches, a button on its
// face alone.
[[nodiscard]] std::int32_t nearest_for_a_finger(const Scene& scene, const Point<'W'>& p, double radius);
[[nodiscard]] double distance_to(const Scene& scene, std::int32_t object, const Point<'W'>& p);  // m

// The part of the benchmark `switching` that judges the choice: right, without chatter, in time.
void add_choice(Bench& bench);

}  // namespace enc::bench::switching
