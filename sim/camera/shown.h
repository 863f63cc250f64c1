// Moving things in front of the twin's stereo head: a hand, parts of the haptic device, the light.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"

namespace enc::sim {

// Linear, 0 to 1, as the images are: a sensor's value is proportional to the light, without gamma.
using Rgb = std::array<float, 3>;

struct HandLook {
  Rgb skin{0.76F, 0.55F, 0.43F};
  Rgb sleeve{0.15F, 0.22F, 0.45F};
  double finger_width = 0.016;  // m, at the cap
  double taper = 1.15;          // width at the knuckle over width at the cap
  double bare = 0.05;           // m of the forearm without sleeve
};

// A pointing hand: one finger straight, the others folded.
struct HandPose {
  Point<'C'> tip;     // centre of the cap's sphere
  Vec<'C'> along;     // direction from knuckle to tip; any length
  double roll = 0.0;  // rad, about `along`
};

// A part of the haptic device, or another moving thing, in front of the camera.
enum class ThingShape : std::uint8_t { sphere, capsule, cylinder, box };
struct Thing {
  ThingShape shape = ThingShape::sphere;
  Point<'C'> at;                 // its middle
  Mat3 axes = Mat3::Identity();  // its x, y and z as columns, in C
  // Half sizes, m. Sphere: x is the radius. Capsule, cylinder: x is the radius, z half the length along z,
  // without caps. Box: half its sides.
  Vec3 half{0.01, 0.01, 0.01};
  Rgb colour{0.25F, 0.26F, 0.28F};
};

struct Light {
  double gain = 1.0;  // factor on all light
  double side = 0.0;  // -1 to 1: position of the lamp, left to right
  Rgb colour{1, 1, 1};
};

// Everything that a camera of the twin sees at an exposure.
struct Shown {
  bool hand = false;  // false: no hand
  HandPose pose;
  HandLook look;
  Light light;
  std::vector<Thing> things;  // besides background and hand
};

}  // namespace enc::sim
