// The look of an object: one of a small library by name, or the material of a glTF file [VHMR 3.5]. Only
// pictures use it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/words.h"

namespace enc {

enum class MaterialName : std::uint8_t {
  unnamed,  // the mesh file's material, else by shape
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

// Values as in glTF 2.0, each from 0 to 1.
struct SurfaceMaterial {
  std::array<float, 3> colour{1, 1, 1};  // red, green, blue, in the screen's encoding
  float metallic = 0.0F, roughness = 1.0F;
  float opacity = 1.0F;
};

}  // namespace enc
