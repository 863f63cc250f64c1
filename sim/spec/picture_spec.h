// What the twin's stereo head is shown, as a rig file names it: a part of [truth.camera].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc::sim {

enum class Scenery : std::uint8_t {
  office,     // wall, desk, things on it: nothing of the hue of skin
  clutter,    // the same, with more of it and finer texture
  skin_hued,  // wood, cardboard, a face of a poster
};
constexpr auto words(Scenery) { return enum_words("office", "clutter", "skin_hued"); }

// Colours of skin, light to dark (skin_tones.h).
enum class Tone : std::uint8_t { fair, light, olive, brown, dark, deep };
constexpr auto words(Tone) { return enum_words("fair", "light", "olive", "brown", "dark", "deep"); }

}  // namespace enc::sim
