// Separation of a bare hand from its background: a part of the rig table [vision].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc {

namespace segmentation {
// Conditions for a pixel to have a hue (hue.h).
struct HueRule {
  std::uint8_t least_chroma = 12;  // out of 255; with noise of 1.5 the hue is then accurate to 0.15 rad
  std::uint8_t least_value = 16;   // out of 255, brightest channel; below it, even black has a colour
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
  int background_frames = 10;  // frames averaged in RGB [VisHap 3]; 1 to 255
  int tile = 5;                // px, side [VisHap 3]; 1 to 15
  int bins = 8;                // bins of hue [VisHap 3]; 1 to 8
  double match = 0.8;          // a tile is foreground if it intersects its background's histogram by less
  double skin = 2.5;           // a pixel is skin if its hue is at most this many spreads from the mean
  double change = 4.0;  // ours: change threshold, in units of the background's noise and the light's residual
  int median = 5;       // px, side of the filter; odd, 1 to 15
  segmentation::HueRule hue;  // grey and dark pixels have no hue: alone they are not skin
  SkinModel model;
};

}  // namespace enc
