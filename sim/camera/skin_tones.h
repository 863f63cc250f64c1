// Skin colours for the hands of a stage, light to dark, linear RGB under the light for which the camera's
// white balance is set.
#pragma once

#include <array>
#include <cstddef>

#include "sim/camera/stage.h"

namespace enc::sim {

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
