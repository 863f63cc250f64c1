// The view of the twin's stereo head, as a rig file names it: a part of [truth.camera].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc::sim {

enum class Scenery : std::uint8_t {
  // Wall, desk, things on it, all far from the hue of skin.
  office,
  clutter,    // the office with more things and finer texture
  skin_hued,  // wood, cardboard, a face on a poster
};
constexpr auto words(Scenery) { return enum_words("office", "clutter", "skin_hued"); }

// Skin colours, light to dark (skin_tones.h).
enum class Tone : std::uint8_t { fair, light, olive, brown, dark, deep };
constexpr auto words(Tone) { return enum_words("fair", "light", "olive", "brown", "dark", "deep"); }

}  // namespace enc::sim
