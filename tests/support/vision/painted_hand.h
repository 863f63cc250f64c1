// A hand of round cones for pictures that are independent of the twin's renderer: a pointing finger, folded
// or spread fingers, a thumb, a palm, a forearm and a sleeve. The dimensions are an adult's (index 88 mm from
// knuckle to fingertip, palm 84 mm wide), rounded; they are not the twin's.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/frames.h"

namespace enc::painted {

enum class Stuff : std::uint8_t { skin, nail, sleeve };

// The volume swept by a ball that moves from `from` to `to` and changes its radius evenly. m
struct Cone {
  Vec3 from, to;
  double from_radius = 0.0, to_radius = 0.0;
  Stuff stuff = Stuff::skin;
  bool tip = false;  // the last part of the pointing finger
};

struct Hit {
  double along = 0.0;  // m along the ray
  Vec3 normal{0, 0, 0};
};
// Computes where a ray from `eye` along the unit vector `ray` enters the cone. False if it misses.
[[nodiscard]] bool meets(const Cone& cone, const Vec3& eye, const Vec3& ray, Hit& hit);

enum class Fingers : std::uint8_t { pointing, fist, open };

struct Hand {
  Vec3 tip{0, 0, 0.5};   // m in C: centre of the pointing finger's cap while the finger is straight
  Vec3 along{0, -1, 0};  // from knuckle to tip
  double roll = 0.0;     // rad about `along`; 0: the back of the hand faces the camera as far as possible
  double size = 1.0;     // scale of all lengths
  double thumb = 0.3;    // rad, away from the finger; below 0.2 it lies on the folded fingers
  double bare = 0.06;    // m of bare forearm before the sleeve
  bool left = false;     // the mirrored hand
  double fold = 0.0;     // fold of the pointing finger: 0 straight, 1 as in a fist
  Fingers fingers = Fingers::pointing;
};

// The hand's parts in C, m.
[[nodiscard]] std::vector<Cone> parts_of(const Hand& hand);
// Radius of the pointing finger's cap, m.
[[nodiscard]] double cap_radius(const Hand& hand);
// m in C: the tips of all fingers that are not folded, the pointing one first, without the thumb.
[[nodiscard]] std::vector<Vec3> fingertips_of(const Hand& hand);

}  // namespace enc::painted
