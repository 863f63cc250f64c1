// The light of a frame relative to that of the background's frames. It uses samples all over the frame, so
// that a region of interest does not change it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/kernels/kernels.h"
#include "core/vision/segmentation/tiles.h"

namespace enc::segmentation {

// A gain for each channel, and a brightness that varies across the image as a plane, for a lamp that moved.
struct Light {
  std::array<double, 3> gain{1.0, 1.0, 1.0};
  // Brightness at the image's middle; change from edge to edge.
  double middle = 1.0, across = 0.0, down = 0.0;
  double colour = 0.0,
         // Residual of this model on the background, as shares of R + G + B.
      bright = 0.0;
};

// Half of a frame's samples may be a hand. So gains are medians (for red and blue, of their ratio to green),
// and the plane is fitted to the samples near it. The residual is the median of the remainders, as a
// Gaussian's standard deviation. If the residual is an eighth of the brightness, the light is unknown, and
// the meter reports the last one.
class LightMeter {
 public:
  LightMeter(const Image& background, const Grid& grid);
  [[nodiscard]] Light measure(const ImageView& frame);  // allocates nothing

 private:
  struct Sample {
    int x = 0, y = 0;  // px, the first of a row of grid_.tile pixels
    std::array<std::uint32_t, 3> was{}, seen{};
    std::array<double, 3> inverse{};   // 1 / was
    double at_x = 0.0, at_y = 0.0;     // -0.5 to 0.5
    double ratio = 1.0;                // measured over expected brightness
    bool clear = false;                // not clipped
    std::size_t right = 0, below = 0;  // the sample an eighth of the image away; 0: no sample
  };
  void look(const ImageView& frame);
  void pair_up();
  // Median over the clear samples; `of` returns 0 to `most`, or a negative value to skip a sample.
  template <class F>
  double median(double most, const F& of);
  void first_plane(Light& light);
  void fit_plane(Light& light);

  Grid grid_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace enc::segmentation
