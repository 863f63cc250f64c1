// Whether the left image is the right camera's: then what both show would lie behind the cameras, where
// nothing is seen.
#pragma once

#include <array>
#include <cstdint>

#include "core/vision/stereo/match.h"

namespace enc {

class Exchanged {
 public:
  static constexpr int kRows = 5, kColumns = 8;  // so many places are looked at in a frame
  static constexpr int kLeast = 6;               // matched ones, that tell something
  static constexpr double kClear = 4.0;          // times as many as of the other way round

  Exchanged(const RectifiedPair& pair, int width, int height);

  // Rows of both images that see() reads, `row` of kRows.
  [[nodiscard]] Region strip(int row) const;
  // Of grey images that are up to date in all strips: is the left one the right camera's? Where a frame shows
  // too little that can be matched, as the one before.
  bool see(const Grey& left, const Grey& right);

 private:
  [[nodiscard]] int matched(const Grey& left, const Grey& right);

  Matcher matcher_;
  int width_ = 0, height_ = 0;
  int frame_ = 0;
  bool exchanged_ = false;
};

}  // namespace enc
