// Finds a fingertip in a mask of skin: steps 1 to 10 of the published pseudo-code, then a fit of the cap's
// circle to the mask's edge [VisHap 2.1.2]; and where it may be in the right image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/words.h"
#include "core/spec/vision_rig.h"
#include "core/vision/stereo/match.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// Pixels dismissed by each step; those that reach step 10 are candidates.
struct StepCounts {
  std::int64_t visited = 0, no_skin = 0, no_depth = 0, too_small = 0, circle = 0, square = 0, pairs = 0;
  std::int64_t candidates = 0;
};

struct Fingertip {
  bool found = false;
  int x = -1, y = -1;                    // px, the chosen candidate
  double column = kUnset, row = kUnset;  // px, the tip's centre
  double radius = kUnset;                // px, r of step 3 at the candidate
  // Seen by a virtual camera that looks straight at the tip (Tangent of cap.h):
  double outline = kUnset;              // px, radius of the fitted circle
  double along_x = 0.0, along_y = 0.0;  // unit vector, from the tip to the knuckle
  double score = kUnset;                // share of skin in the circle
  bool fitted = false;
};

class FingertipFinder {
 public:
  // `r_most`, px: radius at the nearest depth. K / f B = R / B is px of radius for a pixel of disparity.
  FingertipFinder(const FingertipSpec& spec, const RectifiedPair& pair, double r_most, int width, int height);

  // Candidates are searched within `search`. The mask and the disparity count as far as reach(r) beyond it;
  // outside of the image there is no skin. A pixel whose square S leaves the image is dismissed. The first
  // pixel in reading order among the best scores is chosen; the fit starts in the middle of the best ones
  // within r of it.
  //
  // `expected`: predicted position of the tracked finger. If several fingertips are about equally good, the
  // one nearest to it is chosen.
  Fingertip find(const Mask& skin, const DisparityMap& disparity, const Region& search,
                 const Triplet& expected = {});
  // Number of fingertips in the last find(), and each of them: other fingers, in order of preference.
  static constexpr std::size_t kMost = 8;
  [[nodiscard]] std::size_t count() const { return top_count_; }
  [[nodiscard]] Fingertip tip(const Mask& skin, std::size_t index) const;
  [[nodiscard]] const StepCounts& counts() const { return counts_; }
  struct Candidate {
    int x, y;
    float score, radius;
    bool straight;  // the finger is as long as stretch_radii
  };
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }
  // Distance around a pixel with that disparity that steps 4 to 10 read, px.
  [[nodiscard]] int reach(double disparity) const;
  [[nodiscard]] double radius_of(double disparity) const { return per_disparity_ * disparity; }

 private:
  struct Disc {
    // Half width of each row, from the middle row down; px.
    std::vector<std::int16_t> half;
    std::int32_t area = 0;
  };
  void sum(const Mask& skin, const Region& part);
  [[nodiscard]] int in_row(int y, int x0, int x1) const;  // skin in columns x0 to x1 of row y, both included
  [[nodiscard]] int in_column(int x, int y0, int y1) const;
  [[nodiscard]] const Disc& disc(double radius) const;
  [[nodiscard]] int in_circle(int x, int y, const Disc& disc) const;
  [[nodiscard]] int along_square(int x, int y, int half) const;
  [[nodiscard]] int diagonal_pairs(const Mask& skin, int x, int y, int half) const;
  [[nodiscard]] int half_side(double radius) const;
  [[nodiscard]] int stretch(double radius) const;  // px, half a side of the second square
  void look_at(const Mask& skin, const DisparityMap& disparity, int x, int y);
  void choose(const Triplet& expected);

  FingertipSpec spec_;
  RectifiedPair pair_;
  double per_disparity_ = 0.0, r_most_ = 0.0;
  int width_ = 0, height_ = 0;
  std::vector<Disc> discs_;  // radii in steps of 1/4 px
  std::vector<std::uint16_t> rows_, columns_;
  Region part_;  // region of rows_ and columns_
  StepCounts counts_;
  std::vector<Candidate> candidates_;
  std::array<Candidate, kMost> tops_{};
  std::size_t top_count_ = 0;
};

// Disparities of the cap's middle, px.
struct ShiftRange {
  int least = 0, most = 0;
};

// Region of the right image that is compared.
[[nodiscard]] Region opposite(const Fingertip& tip, const ShiftRange& range, const Region& image);
// Possible positions of a fingertip in the right image, by its shape alone: the skin around the tip of the
// left image is shifted over the pixels with the hue of skin in the right one. This needs no detail within
// the finger, which looks the same along its length if it lies along the rows. It fails if the background has
// the hue of skin. Writes the best-fitting shifts, best first, at most as many as `shifts` holds; returns
// their number.
std::size_t alike_shapes(const Mask& left, const Mask& right, const Fingertip& tip, const ShiftRange& range,
                         std::span<float> shifts);

}  // namespace enc
