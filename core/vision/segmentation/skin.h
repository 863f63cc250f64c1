// The colour of skin: one Gaussian of hue, learned offline from images with segmented hands [VisHap 2.1.1].
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/image.h"
#include "core/spec/vision/segmentation_spec.h"
#include "core/vision/segmentation/kernels/hue.h"

namespace enc {

// Takes in images one by one, as many as there are.
class SkinLearner {
 public:
  explicit SkinLearner(const segmentation::HueRule& rule = {}) : rule_(rule) {}
  // The pixels that `hand` has. Throws Error where the two differ in size.
  void add(const ImageView& image, const Mask& hand);
  [[nodiscard]] std::int64_t pixels() const { return pixels_; }  // with a hue
  // Mean on the circle; spread about it, each difference taken the short way round. Throws Error with fewer
  // than two pixels of a hue, and where all directions are alike.
  [[nodiscard]] SkinModel model() const;

 private:
  segmentation::HueRule rule_;
  std::array<std::int64_t, segmentation::kHues> count_{};
  std::array<double, segmentation::kHues> sum_{};  // of the exact hues within, rad
  std::int64_t pixels_ = 0;
};

// Of all images at once, one mask each.
[[nodiscard]] SkinModel learn_skin(std::span<const ImageView> images, std::span<const Mask> hands,
                                   const segmentation::HueRule& rule = {});

}  // namespace enc
