// What an object looks like: one of a small library by name, or the material of a glTF file [VHMR 3.5].
// Pictures alone use it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/words.h"

namespace enc {

enum class MaterialName : std::uint8_t {
  unnamed,  // of the mesh's file, else by shape
  felt,
  rubber,
  plastic,
  wood,
  steel,
  brass,
  glass
};
constexpr auto words(MaterialName) {
  return enum_words("unnamed", "felt", "rubber", "plastic", "wood", "steel", "brass", "glass");
}

// As glTF 2.0 has it; all from 0 to 1.
struct SurfaceMaterial {
  std::array<float, 3> colour{1, 1, 1};  // red, green, blue, as a screen takes them
  float metallic = 0.0F, roughness = 1.0F;
  float opacity = 1.0F;
};

}  // namespace enc
