// The published method: eq. 1 on tiles worked by hand, tiles without a hue, tiles cut off by the image's
// edge.
#include "core/vision/segmentation/tiles.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "core/vision/segmentation/kernels/arc.h"

namespace enc::segmentation {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kRed{200, 20, 20}, kGreen{20, 200, 20}, kBlue{20, 20, 200}, kGrey{90, 90, 90},
    kPaper{250, 250, 250}, kBlack{0, 0, 0};

// The first `first` pixels of a colour, then another.
Image filled(int width, int height, const Rgb& a, const Rgb& b = {}, int first = 1 << 20) {
  Image image(width, height);
  for (int i = 0; i < width * height; ++i) {
    const Rgb& c = i < first ? a : b;
    std::copy(c.begin(), c.end(), image.at(i % width, i / width));
  }
  return image;
}

// H of one tile: the largest share of it that still counts as matched. Everything is skin, so that what is
// left of the tile is foreground.
double intersection(const Image& seen, const Image& model, int tile = 5) {
  const Cut cut = cut_of({0, kHues}, HueRule{});
  const Grid grid{seen.width, seen.height, tile};
  Tiles tiles(kernels(), grid, 8);
  tiles.learn(model, cut);
  const int pixels = seen.width * seen.height;
  for (int common = pixels; common > 0; --common) {
    Mask out(seen.width, seen.height);
    tiles.candidates(seen.view(), out.whole(), static_cast<double>(common) / pixels, cut, out);
    if (std::count(out.on.begin(), out.on.end(), 255) == 0) return static_cast<double>(common) / pixels;
  }
  return 0.0;
}

TEST(Tiles, HaveTheIntersectionOfEquation1) {
  const Image red = filled(5, 5, kRed), green = filled(5, 5, kGreen);
  EXPECT_EQ(intersection(red, red), 1.0);
  EXPECT_EQ(intersection(red, green), 0.0);
  EXPECT_EQ(intersection(filled(4, 4, kRed, kGreen, 8), filled(4, 4, kRed), 4), 0.5);
  EXPECT_EQ(intersection(filled(4, 4, kRed), filled(4, 4, kRed, kGreen, 8), 4), 0.5);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGreen, 10), filled(5, 5, kRed, kBlue, 15)), 0.4);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGreen, 10), filled(5, 5, kGreen, kRed, 10)), 20.0 / 25.0);
  EXPECT_EQ(intersection(filled(15, 15, kRed), filled(15, 15, kRed), 15),
            1.0);  // 225 pixels: a byte holds them
}

// A grey tile has no hue: it is like other grey ones, and unlike a hand; as red as OpenCV's hue 0 it is not.
TEST(Tiles, WithoutAHueAreAlikeAndUnlikeTheRest) {
  const Image grey = filled(5, 5, kGrey);
  EXPECT_EQ(intersection(filled(5, 5, kGrey, kRed, 24), filled(5, 5, kPaper, kRed, 24)), 1.0);
  const Image red = filled(5, 5, kRed);
  EXPECT_EQ(intersection(red, grey), 0.0);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGrey, 5), filled(5, 5, kBlack, kRed, 20)), 1.0);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGrey, 5), filled(5, 5, kGreen, kGrey, 5)), 0.8);
}

TEST(Tiles, NeedAWholeNumberOfPixels) {
  EXPECT_EQ(needed(0.5, 25), 13);
  EXPECT_EQ(needed(0.5, 24), 12);
  EXPECT_EQ(needed(0.6, 25), 15);  // not 16 for a rounding
  EXPECT_EQ(needed(0.0, 25), 0);
  EXPECT_EQ(needed(1.0, 25), 25);
  EXPECT_EQ(needed(7.0, 25), 26);  // never reached: all is foreground
}

// 13 x 12: the last tiles have 3 columns, 2 rows or both; each differs in its own pixels only.
TEST(Tiles, AtTheEdgeAreJudgedByWhatTheyHave) {
  const Cut cut = cut_of({0, kHues}, HueRule{});
  const Grid grid{13, 12, 5};
  for (const Kernels* kernels : {&plain_kernels(), &segmentation::kernels()})
    for (int row = 0; row < grid.rows(); ++row)
      for (int column = 0; column < grid.columns(); ++column) {
        Tiles tiles(*kernels, grid, 8);
        tiles.learn(filled(13, 12, kRed), cut);
        Image image = filled(13, 12, kRed);
        const Region tile = grid.tile_at(column, row);
        for (int y = tile.y0; y < tile.y1; ++y)
          for (int x = tile.x0; x < tile.x1; ++x) std::copy(kBlue.begin(), kBlue.end(), image.at(x, y));
        Mask out(13, 12);
        tiles.candidates(image.view(), out.whole(), 0.5, cut, out);
        for (int y = 0; y < 12; ++y)
          for (int x = 0; x < 13; ++x) ASSERT_EQ(out.at(x, y), tile.contains(x, y)) << x << " " << y;
      }
}

}  // namespace
}  // namespace enc::segmentation
