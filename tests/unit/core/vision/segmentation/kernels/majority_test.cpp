// The median of a mask: against counting each window, and its two promises.
#include "core/vision/segmentation/kernels/majority.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace enc::segmentation {
namespace {

Mask random_mask(int width, int height, std::uint32_t seed) {
  std::mt19937 random(seed);
  Mask mask(width, height);
  for (auto& on : mask.on) on = random() % 2 != 0 ? 255 : 0;
  return mask;
}

Mask counted(const Mask& in, int side) {
  Mask out(in.width, in.height);
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x) {
      int count = 0;
      for (int dy = -side / 2; dy <= side / 2; ++dy)
        for (int dx = -side / 2; dx <= side / 2; ++dx)
          count += in.at(std::clamp(x + dx, 0, in.width - 1), std::clamp(y + dy, 0, in.height - 1)) ? 1 : 0;
      out.row(y)[x] = 2 * count > side * side ? 255 : 0;
    }
  return out;
}

TEST(Majority, IsWhatCountingEachWindowGives) {
  for (const int side : {1, 3, 5, 9, 15})
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {33, 7}, {70, 41}})
      for (const Kernels* kernels : {&plain_kernels(), &segmentation::kernels()}) {
        const Mask in = random_mask(width, height, 1);
        Mask out(width, height);
        Majority(*kernels, side, width).filter(in, in.whole(), out);
        EXPECT_EQ(out.on, counted(in, side).on) << side << " " << width << " " << height;
      }
}

TEST(Majority, OfARegionIsThatOfTheWhole) {
  const Mask in = random_mask(90, 60, 2);
  Majority median(kernels(), 5, 90);
  Mask whole(90, 60);
  median.filter(in, in.whole(), whole);
  for (const Region& region : {Region{0, 0, 5, 5}, Region{10, 20, 55, 25}, Region{85, 50, 90, 60}}) {
    Mask part(90, 60);
    std::fill(part.on.begin(), part.on.end(), std::uint8_t{7});
    median.filter(in, region, part);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 90; ++x) ASSERT_EQ(part.row(y)[x], region.contains(x, y) ? whole.row(y)[x] : 7);
  }
}

TEST(Majority, RemovesEveryIsolatedPixel) {
  Mask in(64, 48), out(64, 48);
  int alone = 0;
  for (int y = 0; y < 48; y += 3)  // none has another among its eight neighbours; corners and edges, too
    for (int x = 0; x < 64; x += 3) {
      in.row(y)[x] = 255;
      ++alone;
    }
  ASSERT_GT(alone, 300);
  Majority(kernels(), 5, 64).filter(in, in.whole(), out);
  EXPECT_EQ(std::count(out.on.begin(), out.on.end(), 255), 0);
}

// Down to a radius of 10 px; one of 8 loses 2.5 %.
TEST(Majority, KeepsADiscsArea) {
  for (const double radius : {10.0, 15.0, 40.0, 90.0}) {
    Mask in(200, 200), out(200, 200);
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x)
        in.row(y)[x] = (x - 99.7) * (x - 99.7) + (y - 100.2) * (y - 100.2) < radius * radius ? 255 : 0;
    Majority(kernels(), 5, 200).filter(in, in.whole(), out);
    const auto area = [](const Mask& m) {
      return static_cast<double>(std::count(m.on.begin(), m.on.end(), 255));
    };
    EXPECT_NEAR(area(out) / area(in), 1.0, 0.02) << radius;
  }
}

}  // namespace
}  // namespace enc::segmentation
