// How a bare hand is told from what is behind it: a part of the rig table [vision].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc {

namespace segmentation {
// Where a pixel has a hue (hue.h).
struct HueRule {
  std::uint8_t least_chroma = 12;  // of 255: with 1.5 of noise the hue is then good to 0.15 rad
  std::uint8_t least_value = 16;   // of 255: of the brightest channel; below, black itself has a colour
};
}  // namespace segmentation

// One Gaussian of hue [VisHap 2.1.1].
struct SkinModel {
  double hue = 0.0;     // rad, mean; the circle's 0 is red
  double spread = 0.0;  // rad, standard deviation
};

enum class SegmentationMethod : std::uint8_t {
  published,  // tiles.h
  ours,       // change.h
};
constexpr auto words(SegmentationMethod) { return enum_words("published", "ours"); }

struct SegmentationSpec {
  SegmentationMethod method = SegmentationMethod::published;
  int background_frames = 10;  // averaged in RGB [VisHap 3]; 1 to 255
  int tile = 5;                // px, side [VisHap 3]; 1 to 15
  int bins = 8;                // of hue [VisHap 3]; 1 to 8
  double match = 0.8;          // a tile that intersects its background's histogram by less is foreground
  double skin = 2.5;           // a pixel whose hue is at most so many spreads from the mean is skin
  double change = 4.0;         // ours: so many times the background's noise, and what light leaves, is none
  int median = 5;              // px, side of the filter; odd, 1 to 15
  segmentation::HueRule hue;   // grey and dark pixels have no hue: alone they are no skin
  SkinModel model;
};

}  // namespace enc
