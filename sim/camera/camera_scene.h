// Things that a camera of the twin sees: a hand and its colours, parts of the haptic device, the light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "sim/spec/sensor_spec.h"

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
  friend bool operator==(const Light&, const Light&) = default;
};

// Everything that a camera of the twin sees at an exposure.
struct CameraScene {
  bool hand = false;  // false: no hand
  HandPose pose;
  HandLook look;
  Light light;
  std::vector<Thing> things;  // besides background and hand
};

// Skin colours for the hands of a stage, light to dark, linear RGB under the light for which the camera's
// white balance is set.
struct SkinTone {
  Tone tone;
  Rgb colour;
  bool measured;  // false: assumed
};

// Measured: patches 2 and 1 of the ColorChecker, which imitate measured skin [McCamy 1976], from their
// published sRGB (194, 150, 130) and (115, 82, 68). Assumed: the two between these, and one beyond either
// end, with hues of 12 to 19 degrees, near theirs (16 and 14).
inline constexpr std::array<SkinTone, 6> kSkinTones{{
    {Tone::fair, {0.660F, 0.440F, 0.360F}, false},
    {Tone::light, {0.539F, 0.305F, 0.223F}, true},
    {Tone::olive, {0.413F, 0.231F, 0.144F}, false},
    {Tone::brown, {0.275F, 0.144F, 0.089F}, false},
    {Tone::dark, {0.171F, 0.084F, 0.058F}, true},
    {Tone::deep, {0.090F, 0.044F, 0.032F}, false},
}};

[[nodiscard]] constexpr Rgb skin_colour(Tone tone) {
  return kSkinTones[static_cast<std::size_t>(tone)].colour;
}

}  // namespace enc::sim
