// The colour of skin: one Gaussian of hue, learned offline from images with segmented hands [VisHap 2.1.1].
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/image.h"
#include "core/spec/vision/segmentation_spec.h"
#include "core/vision/segmentation/kernels/hue.h"

namespace enc {

// Takes any number of images, one by one.
class SkinLearner {
 public:
  explicit SkinLearner(const segmentation::HueRule& rule = {}) : rule_(rule) {}
  // Adds the pixels of the mask `hand`. Throws Error if the sizes differ.
  void add(const ImageView& image, const Mask& hand);
  [[nodiscard]] std::int64_t pixels() const { return pixels_; }  // pixels with a hue
  // Mean on the circle; the spread takes each difference the short way around. Throws Error with fewer than
  // two pixels of a hue, or if the hues are uniform around the circle.
  [[nodiscard]] SkinModel model() const;

 private:
  segmentation::HueRule rule_;
  std::array<std::int64_t, segmentation::kHues> count_{};
  std::array<double, segmentation::kHues> sum_{};  // sums of the exact hues in each bin, rad
  std::int64_t pixels_ = 0;
};

// Learns from all images at once, one mask each.
[[nodiscard]] SkinModel learn_skin(std::span<const ImageView> images, std::span<const Mask> hands,
                                   const segmentation::HueRule& rule = {});

}  // namespace enc
