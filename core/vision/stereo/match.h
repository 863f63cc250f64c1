// Disparity: the column in the left image minus that of the same point in the right one. Minimises the sum of
// absolute differences of a grey block over all positions that the depths allow.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/spec/vision_rig.h"
#include "core/vision/stereo/grey.h"
#include "core/vision/stereo/match_kernel.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// Result for a pixel.
enum class MatchOutcome : std::uint8_t { yes, outside, at_limit, not_unique, not_mutual };

struct Disparity {
  MatchOutcome matched = MatchOutcome::outside;
  float pixels = 0.0F;  // parabola through the least cost and its neighbours; NaN unless matched
};

class Matcher {
 public:
  // Throws Error if the block or the depths are impossible, or the depths need more than 512 positions.
  Matcher(const MatchSpec& spec, const RectifiedPair& pair,
          const match_kernel::Kernel& kernel = match_kernel::best());

  // The result for a pixel does not depend on other requests. Reads `left` and `right` within left_of() and
  // right_of() of it. With a mask, only the block's pixels within it are compared: the background of a thin
  // finger is elsewhere in the other image.
  [[nodiscard]] Disparity at(const Grey& left, const Grey& right, int x, int y, const Mask* mask = nullptr);
  // Pixels of the left and right image that at() reads for those of `wanted`.
  [[nodiscard]] Region left_of(const Region& wanted) const;
  [[nodiscard]] Region right_of(const Region& wanted) const;
  [[nodiscard]] int least() const { return least_; }  // px
  [[nodiscard]] int most() const { return most_; }

 private:
  // A block, and the part of it that counts; null: the whole block.
  struct Block {
    const std::uint8_t* level;
    std::size_t stride;
    const std::uint8_t* on;
    std::size_t on_stride;
  };
  void compare(const Block& block, const std::uint8_t* strip, std::size_t stride, int count);
  [[nodiscard]] bool mutual(const Grey& left, const Block& block, int column, int y, int disparity);

  MatchSpec spec_;
  int least_ = 0, most_ = 0;
  match_kernel::Kernel kernel_;
  std::array<std::uint16_t, match_kernel::kMost + 16> cost_{};
};

// Disparity of the pixels of a mask. It is matched at the middles of small cells of one grid, so that a
// window gives the same result as the whole frame.
class DisparityMap {
 public:
  // px, side; 1 px of the image is 0.8 mm at 600 mm.
  static constexpr int kCell = 4;
  // px: a pixel's value depends on the mask up to this distance, including half of the widest block.
  static constexpr int kReach = 2 * kCell + 8;

  DisparityMap(int width, int height);

  // Matches the cells that touch `wanted` or are next to those, if their middle is in the mask.
  void match(Matcher& matcher, const Grey& left, const Grey& right, const Mask& mask, const Region& wanted);
  // Sets one disparity everywhere.
  void fill(float disparity);
  // Median of the nine cells around the pixel; NaN if no cell has a value.
  [[nodiscard]] float at(int x, int y) const {
    return smooth_[static_cast<std::size_t>(y / kCell) * columns_ + static_cast<std::size_t>(x / kCell)];
  }
  // Cells searched and matched by the last match().
  [[nodiscard]] std::int64_t sought() const { return sought_; }
  [[nodiscard]] std::int64_t found() const { return found_; }

 private:
  [[nodiscard]] float median_round(std::size_t column, std::size_t row) const;

  std::size_t columns_ = 0, rows_ = 0;
  std::vector<float> raw_, smooth_;
  std::int64_t sought_ = 0, found_ = 0;
};

// Detects exchanged images: the left image is from the right camera. Everything in both images would then lie
// behind the cameras, where no camera can see.
class ExchangeCheck {
 public:
  static constexpr int kRows = 5, kColumns = 8;  // places examined in a frame
  static constexpr int kLeast = 6;               // fewest matched places for a decision
  static constexpr double kClear = 4.0;          // factor over the matches of the other order

  ExchangeCheck(const RectifiedPair& pair, int width, int height);

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
