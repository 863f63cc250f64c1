// Disparity: the column in the left image minus that of the same point in the right one. Minimises the sum of
// absolute differences of a grey block over all positions that the depths allow.
#pragma once

#include <array>
#include <cstdint>

#include "core/spec/vision/match_spec.h"
#include "core/vision/stereo/grey.h"
#include "core/vision/stereo/match_kernel.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// Result for a pixel.
enum class Matched : std::uint8_t { yes, outside, at_limit, not_unique, not_mutual };

struct Disparity {
  Matched matched = Matched::outside;
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

}  // namespace enc
