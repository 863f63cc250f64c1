#include "core/vision/augment/clean_background.h"

#include <array>
#include <cstddef>
#include <cstdlib>

namespace enc::augment {
namespace {

// Of a gap: colours at its ends in a row or a column, weighted by the inverse of the squared distance.
using Weighed = std::array<float, 4>;  // r, g, b times the weight, and the weight

// Along one line of pixels, `step` apart, there or back: each unknown one gets what was known last.
void sweep(const Image& image, const Mask& known, std::ptrdiff_t first, std::ptrdiff_t step, int count,
           std::vector<Weighed>& sums) {
  std::ptrdiff_t last = -1;
  int since = 0;
  for (int i = 0; i < count; ++i) {
    const std::ptrdiff_t at = first + i * step;
    if (known.on[static_cast<std::size_t>(at)] != 0) {
      last = at;
      since = 0;
      continue;
    }
    ++since;
    if (last < 0) continue;
    const float weight = 1.0F / static_cast<float>(since * since);
    Weighed& sum = sums[static_cast<std::size_t>(at)];
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += weight * static_cast<float>(image.rgb[3 * static_cast<std::size_t>(last) + c]);
    sum[3] += weight;
  }
}

}  // namespace

CleanBackground::CleanBackground(int width, int height, int frames)
    : frames_(frames),
      known_(width, height),
      image_(width, height),
      sum_(image_.rgb.size()),
      count_(known_.on.size()) {}

void CleanBackground::add(const ImageView& frame, const Mask& covered) {
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (known_.on[i] != 0 || covered.on[i] != 0) continue;
    const std::uint8_t* p = frame.rgb + 3 * i;
    std::uint16_t* sum = sum_.data() + 3 * i;
    int n = count_[i];
    for (std::size_t c = 0; c < 3 && n > 0; ++c)
      if (std::abs(n * p[c] - sum[c]) > n * kAlike) n = 0;
    for (std::size_t c = 0; c < 3; ++c) sum[c] = static_cast<std::uint16_t>((n > 0 ? sum[c] : 0) + p[c]);
    count_[i] = static_cast<std::uint8_t>(++n);
    if (n < frames_) continue;
    for (std::size_t c = 0; c < 3; ++c)
      image_.rgb[3 * i + c] = static_cast<std::uint8_t>((sum[c] + n / 2) / n);
    known_.on[i] = 255;
    any_ = stale_ = true;
  }
}

// A gap is filled from its four sides, so that edges along rows and columns go on behind it.
void CleanBackground::fill() {
  std::vector<Weighed> sums(count_.size());
  const std::ptrdiff_t width = image_.width, height = image_.height;
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    sweep(image_, known_, y * width, 1, image_.width, sums);
    sweep(image_, known_, (y + 1) * width - 1, -1, image_.width, sums);
  }
  for (std::ptrdiff_t x = 0; x < width; ++x) {
    sweep(image_, known_, x, width, image_.height, sums);
    sweep(image_, known_, (height - 1) * width + x, -width, image_.height, sums);
  }
  for (std::size_t i = 0; i < count_.size(); ++i)
    for (std::size_t c = 0; c < 3 && known_.on[i] == 0; ++c)
      image_.rgb[3 * i + c] =
          sums[i][3] > 0.0F ? static_cast<std::uint8_t>(sums[i][c] / sums[i][3] + 0.5F) : std::uint8_t{0};
}

const Image& CleanBackground::image() {
  if (stale_) fill();
  stale_ = false;
  return image_;
}

}  // namespace enc::augment
