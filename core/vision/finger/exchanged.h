// Detects exchanged images: the left image is from the right camera. Everything in both images would then lie
// behind the cameras, where no camera can see.
#pragma once

#include <array>
#include <cstdint>

#include "core/vision/stereo/match.h"

namespace enc {

class Exchanged {
 public:
  static constexpr int kRows = 5, kColumns = 8;  // places examined in a frame
  static constexpr int kLeast = 6;               // fewest matched places for a decision
  static constexpr double kClear = 4.0;          // factor over the matches of the other order

  Exchanged(const RectifiedPair& pair, int width, int height);

  // Rows of both images that see() reads; `row` is below kRows.
  [[nodiscard]] Region strip(int row) const;
  // True if the left image is the right camera's. The grey images must be up to date in all strips. If a
  // frame has too few matches, the last answer stays.
  bool see(const Grey& left, const Grey& right);

 private:
  [[nodiscard]] int matched(const Grey& left, const Grey& right);

  Matcher matcher_;
  int width_ = 0, height_ = 0;
  int frame_ = 0;
  bool exchanged_ = false;
};

}  // namespace enc
