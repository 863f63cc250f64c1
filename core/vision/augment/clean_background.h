// The background without what stood before it, completed over time: each pixel is learned from frames in
// which nothing covers it, whenever those come.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace enc::augment {

class CleanBackground {
 public:
  // `frames`: of which a pixel is the mean, as many as of the tracker's background.
  CleanBackground(int width, int height, int frames);

  // A frame, and what of it may not be the background. A pixel is learned from so many uncovered frames that
  // agree with each other: what moves does not get in. Once learned it stays.
  void add(const ImageView& frame, const Mask& covered);
  [[nodiscard]] const Mask& known() const { return known_; }
  [[nodiscard]] bool any() const { return any_; }  // pixel is known
  // Where it was never uncovered it goes on from what lies around.
  [[nodiscard]] const Image& image();

  static constexpr int kAlike = 12;  // of 255, a channel: eight times a sensor's noise of 1.5

 private:
  void fill();

  int frames_;
  bool any_ = false;
  bool stale_ = true;  // something was learned since it was filled
  Mask known_;
  Image image_;
  std::vector<std::uint16_t> sum_;
  std::vector<std::uint8_t> count_;
};

}  // namespace enc::augment
