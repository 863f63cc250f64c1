// Evaluates images of hands and their masks: the colour of skin [VisHap 2.1.1], and how well hue alone
// separates a hand from the rest of these images.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vision/segmentation/skin.h"

namespace enc::app {

struct HandFiles {
  std::string image, mask;
};

// Pixels of the hand or of the rest.
struct HueCounts {
  std::array<std::int64_t, segmentation::kHues> hue{};
  std::int64_t grey = 0, dark = 0;  // without a hue: the chroma, or the brightest channel, is below HueRule
  std::int64_t all = 0;
};
struct SkinStudy {
  std::size_t images = 0;
  SkinModel model;
  HueCounts hand, rest;
  std::vector<std::string> unlike;  // masks with mostly other hues than the model's
};

// Both throw Error in one line that begins with a folder or a file: a mask or an image without the other, one
// of another size, a mask that is a picture, a mask with no hand or nothing else, a hand without any hue.
// After the first, no output can overwrite the files.
[[nodiscard]] std::vector<HandFiles> list_hands(const std::string& images, const std::string& masks);
[[nodiscard]] SkinStudy study_skin(const std::vector<HandFiles>& files);

[[nodiscard]] std::string skin_text(const SkinStudy& study);
[[nodiscard]] std::string skin_json(const SkinStudy& study);
[[nodiscard]] std::string skin_toml(const SkinStudy& study);  // the lines for a rig's table [vision]

}  // namespace enc::app
