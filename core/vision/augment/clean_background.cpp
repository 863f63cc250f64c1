#include "core/vision/augment/clean_background.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace enc::augment {
namespace {

// A coarser picture of what is known: each pixel the mean of the known ones of four.
struct Level {
  int width = 0, height = 0;
  std::vector<std::array<float, 4>> pixels;  // r, g, b, and 1 where known

  Level(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] std::array<float, 4>& at(int x, int y) {
    return pixels[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  }
};

Level coarser(Level& fine) {
  Level coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      const auto& from = fine.at(x, y);
      auto& to = coarse.at(x / 2, y / 2);
      for (std::size_t c = 0; c < 4; ++c) to[c] += from[c] * from[3];
    }
  for (auto& p : coarse.pixels) {
    if (!(p[3] > 0.0F)) continue;
    for (std::size_t c = 0; c < 3; ++c) p[c] /= p[3];
    p[3] = 1.0F;
  }
  return coarse;
}

// What is not known becomes what the coarser picture has there, bilinear.
void fill_from(Level& coarse, Level& fine) {
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      auto& p = fine.at(x, y);
      if (p[3] > 0.0F) continue;
      const int u = (x - 1) / 2 + (x == 0 ? -1 : 0), v = (y - 1) / 2 + (y == 0 ? -1 : 0);
      const float right = x % 2 == 0 ? 0.75F : 0.25F, down = y % 2 == 0 ? 0.75F : 0.25F;
      for (std::size_t c = 0; c < 3; ++c)
        p[c] = (1.0F - down) * ((1.0F - right) * coarse.at(u, v)[c] + right * coarse.at(u + 1, v)[c]) +
               down * ((1.0F - right) * coarse.at(u, v + 1)[c] + right * coarse.at(u + 1, v + 1)[c]);
      p[3] = 1.0F;
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
    stale_ = true;
  }
}

// Push and pull: means of what is known, coarser and coarser, then back into the gaps [Gortler et al. 1996].
void CleanBackground::fill() {
  std::vector<Level> levels{Level(image_.width, image_.height)};
  for (std::size_t i = 0; i < count_.size(); ++i) {
    const std::uint8_t* p = image_.rgb.data() + 3 * i;
    if (known_.on[i] != 0)
      levels[0].pixels[i] = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                             1.0F};
  }
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t i = levels.size() - 1; i > 0; --i) fill_from(levels[i], levels[i - 1]);
  for (std::size_t i = 0; i < count_.size(); ++i)
    for (std::size_t c = 0; c < 3 && known_.on[i] == 0; ++c)
      image_.rgb[3 * i + c] = static_cast<std::uint8_t>(levels[0].pixels[i][c] + 0.5F);
}

const Image& CleanBackground::image() {
  if (stale_) fill();
  stale_ = false;
  return image_;
}

}  // namespace enc::augment
