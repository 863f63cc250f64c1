// The background without the objects in front of it, completed over time: each pixel is learned from frames
// that show it uncovered, whenever they come.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace enc::augment {

class CleanBackground {
 public:
  // `frames`: number of frames averaged for a pixel, as many as for the tracker's background.
  CleanBackground(int width, int height, int frames);

  // Adds a frame; `covered` marks pixels that may not be background. A pixel is learned from that number of
  // uncovered frames that agree with each other, so moving things do not get in. Once learned, a pixel stays.
  void add(const ImageView& frame, const Mask& covered);
  [[nodiscard]] const Mask& known() const { return known_; }
  [[nodiscard]] bool any() const { return any_; }  // true if any pixel is known
  // The background; pixels that were never uncovered are continued from their surroundings.
  [[nodiscard]] const Image& image();

  // Out of 255, each channel: eight times a sensor's noise of 1.5.
  static constexpr int kAlike = 12;

 private:
  void fill();

  int frames_;
  bool any_ = false;
  bool stale_ = true;  // learned more since the last fill
  Mask known_;
  Image image_;
  std::vector<std::uint16_t> sum_;
  std::vector<std::uint8_t> count_;
};

}  // namespace enc::augment
