// Textures made in code, by seed, for the things of a scenery and the skin of a hand.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/camera/stage.h"
#include "sim/truth/random.h"

namespace enc::sim {

struct Texture {
  int side = 0;  // px; square
  std::vector<std::uint8_t> rgb;
  explicit Texture(int pixels)
      : side(pixels), rgb(3 * static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels)) {}
  void set(int x, int y, const Rgb& colour);
};

// Hue in degrees, saturation and value 0 to 1.
[[nodiscard]] Rgb of_hue(double hue, double saturation, double value);
// Any hue far from that of skin: 70 to 325 degrees, i.e. 20 degrees away from 345 to 50.
[[nodiscard]] Rgb cool_colour(Stream& random, double saturation, double value);
// The colour times a factor.
[[nodiscard]] Rgb shaded(const Rgb& colour, double by);

[[nodiscard]] Texture plaster(Stream& random, const Rgb& colour, double grain, int side = 512);
[[nodiscard]] Texture wood(Stream& random, const Rgb& light, const Rgb& dark);
[[nodiscard]] Texture weave(Stream& random, const Rgb& colour);                // cloth, keys, card
[[nodiscard]] Texture text(Stream& random, const Rgb& paper, const Rgb& ink);  // lines of words
[[nodiscard]] Texture screen(Stream& random);                                  // windows of a computer
[[nodiscard]] Texture patches(Stream& random, double saturation);              // a picture of many colours
[[nodiscard]] Texture face(Stream& random);                                    // a poster of a face
[[nodiscard]] Texture skin(Stream& random);  // factors of skin's colour: blotches, creases, pores

}  // namespace enc::sim
