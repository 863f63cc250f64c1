// Segments a bare hand [VisHap 2.1.1]: background by histograms of hue of small tiles, then skin by one
// Gaussian of hue, then a median. A second method, ours, handles other light and skin-hued backgrounds.
#pragma once

#include <memory>

#include "core/base/image.h"
#include "core/spec/vision_rig.h"

namespace enc {

class Segmenter {
 public:
  // Throws Error for an invalid spec, including an unlearned model (a spread of 0).
  Segmenter(const SegmentationSpec& spec, int width, int height);
  ~Segmenter();
  Segmenter(Segmenter&&) noexcept;
  Segmenter& operator=(Segmenter&&) noexcept;

  // Takes one frame of the background. Returns true once there were enough and the model is made; later
  // frames change nothing. Throws Error for a frame of another size.
  bool learn(const ImageView& frame);
  [[nodiscard]] bool learned() const;
  // Once learned: share of the background's tiles in which something moved meanwhile, such as a finger.
  [[nodiscard]] double unrest() const;
  // Sets `match` (or `change` for our method) and `skin` from the next frame on.
  void thresholds(double foreground, double skin);
  // The tiles of the grid that touch `wanted`.
  [[nodiscard]] Region on_grid(const Region& wanted) const;
  // Writes the skin of the foreground within on_grid(wanted), and returns that region; the result is equal to
  // the bit to that of the whole frame. Other pixels of `skin` stay. Allocates nothing. Throws Error before
  // the background is learned, and if frame or mask have another size.
  Region segment(const ImageView& frame, const Region& wanted, Mask& skin);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
