// A hand of round cones for pictures that owe nothing to the twin's renderer: a pointing finger, folded or
// spread fingers, a thumb, a palm, a forearm and a sleeve. The dimensions are those of an adult's hand
// (index 88 mm from knuckle to fingertip, palm 84 mm wide), rounded; they are not the twin's.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/frames.h"

namespace enc::painted {

enum class Stuff : std::uint8_t { skin, nail, sleeve };

// What a ball covers that goes from `from` to `to` and changes its radius evenly. m
struct Cone {
  Vec3 from, to;
  double from_radius = 0.0, to_radius = 0.0;
  Stuff stuff = Stuff::skin;
  bool tip = false;  // the last part of the finger that points
};

struct Hit {
  double along = 0.0;  // m, of the ray
  Vec3 normal{0, 0, 0};
};
// Where a ray from `eye` along the unit vector `ray` enters the cone. False where it does not.
[[nodiscard]] bool meets(const Cone& cone, const Vec3& eye, const Vec3& ray, Hit& hit);

enum class Fingers : std::uint8_t { pointing, fist, open };

struct Hand {
  Vec3 tip{0, 0, 0.5};   // m in C: middle of the cap of the finger that points, while that is straight
  Vec3 along{0, -1, 0};  // from knuckle to tip
  double roll = 0.0;     // rad about `along`; 0: the back of the hand faces the camera as far as it can
  double size = 1.0;     // of all lengths
  double thumb = 0.3;    // rad, away from the finger; below 0.2 it lies on the folded fingers
  double bare = 0.06;    // m of the forearm that no sleeve covers
  bool left = false;     // the mirrored hand
  double fold = 0.0;     // of the finger that points: 0 straight, 1 as the others of a fist
  Fingers fingers = Fingers::pointing;
};

// The hand's parts in C, m.
[[nodiscard]] std::vector<Cone> parts_of(const Hand& hand);
// m, of the cap of the finger that points.
[[nodiscard]] double cap_radius(const Hand& hand);
// m in C: the ends of all fingers that are not folded, the pointing one first. The thumb is none of them.
[[nodiscard]] std::vector<Vec3> fingertips_of(const Hand& hand);

}  // namespace enc::painted
