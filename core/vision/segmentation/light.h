// The light of a frame against that of the background's frames, from samples all over the frame, so that a
// region of interest does not change it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/grid.h"
#include "core/vision/segmentation/kernels/kernels.h"

namespace enc::segmentation {

// A gain for each channel; beside that the brightness runs across the image as a plane, where a lamp moved.
struct Light {
  std::array<double, 3> gain{1.0, 1.0, 1.0};
  double middle = 1.0, across = 0.0, down = 0.0;  // at the image's middle; from one edge to the other
  double colour = 0.0,
         bright = 0.0;  // what this leaves unexplained of the background, as shares of R + G + B
};

// Half of a frame's samples may be a hand: gains are medians (those of red and blue are of their ratio to
// green), the plane is fitted to what lies near it, and what is left is the median of the remainders, as a
// Gaussian's standard deviation. Where that is an eighth of the brightness the light is not known, and said
// to be what it was.
class LightMeter {
 public:
  LightMeter(const Image& background, const Grid& grid);
  [[nodiscard]] Light measure(const ImageView& frame);  // allocates nothing

 private:
  struct Sample {
    int x = 0, y = 0;  // px, the first of a row of grid_.tile pixels
    std::array<std::uint32_t, 3> was{}, seen{};
    std::array<double, 3> inverse{};   // of was
    double at_x = 0.0, at_y = 0.0;     // -0.5 to 0.5
    double ratio = 1.0;                // brightness seen over expected
    bool clear = false;                // not clipped
    std::size_t right = 0, below = 0;  // the sample an eighth of the image away; 0 for none
  };
  void look(const ImageView& frame);
  void pair_up();
  template <class F>
  double median(double most,
                const F& of);  // of the clear samples; `of` gives 0 to `most`, below 0 what does not count
  void first_plane(Light& light);
  void fit_plane(Light& light);

  Grid grid_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace enc::segmentation
