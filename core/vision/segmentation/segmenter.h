// Which pixels are a bare hand [VisHap 2.1.1]: background by histograms of hue of small tiles, then skin by
// one Gaussian of hue, then a median. And a second method, ours, for other light and skin-hued backgrounds.
#pragma once

#include <memory>

#include "core/base/image.h"
#include "core/spec/vision/segmentation_spec.h"

namespace enc {

class Segmenter {
 public:
  // Throws Error for what the spec must not be: a model that nobody learned (a spread of 0) among it.
  Segmenter(const SegmentationSpec& spec, int width, int height);
  ~Segmenter();
  Segmenter(Segmenter&&) noexcept;
  Segmenter& operator=(Segmenter&&) noexcept;

  // One frame of the background; true once there were enough, and the model is made: later ones change
  // nothing. Throws Error where a frame has another size.
  bool learn(const ImageView& frame);
  [[nodiscard]] bool learned() const;
  // Once learned: share of the background's tiles in which something moved meanwhile, such as a finger.
  [[nodiscard]] double unrest() const;
  // From the next frame on: `match`, or `change` where the method is ours; and `skin`.
  void thresholds(double foreground, double skin);
  // The tiles of the one grid that `wanted` touches.
  [[nodiscard]] Region on_grid(const Region& wanted) const;
  // Skin of the foreground within on_grid(wanted), which it returns; equal to the bit to the whole frame's
  // there. Other pixels of `skin` keep what they have. Allocates nothing. Throws Error before the background
  // is learned, and where frame or mask have another size.
  Region segment(const ImageView& frame, const Region& wanted, Mask& skin);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
