// The AVX2 kernels equal their plain twins to the bit: for every colour, over random images and at every
// width up to several rounds of the fast loop.
#include "core/vision/segmentation/kernels/kernels.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/kernels/majority.h"

namespace enc::segmentation {
namespace {

using Bytes = std::vector<std::uint8_t>;
std::size_t at(int i) { return static_cast<std::size_t>(i); }

Bytes noise(int n, std::uint32_t seed, int most = 255) {
  std::mt19937 random(seed);
  Bytes bytes(at(n));
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random() % static_cast<std::uint32_t>(most + 1));
  return bytes;
}
Bytes mask(int n, std::uint32_t seed) {
  Bytes bytes = noise(n, seed);
  for (auto& b : bytes) b = b > 127 ? 255 : 0;
  return bytes;
}

class Twins : public ::testing::Test {
 protected:
  void SetUp() override {
    if (avx2_kernels() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  }
  const Kernels& plain = plain_kernels();
  const Kernels& fast = kernels();
};

// Arcs of all kinds: short, over red, on the edges of sextants, of more than half a turn, none and all.
std::vector<Arc> arcs() {
  std::vector<Arc> all{{0, 0},   {0, kHues},  {0, 1},      {1535, 2},  {256, 256},  {255, 2},
                       {256, 1}, {1400, 300}, {100, 768},  {100, 769}, {900, 1535}, {512, 1},
                       {511, 1}, {5, 1000},   {1280, 256}, {20, 100}};
  std::mt19937 random(3);
  for (int i = 0; i < 12; ++i)
    all.push_back({static_cast<int>(random() % kHues), static_cast<int>(random() % (kHues + 1))});
  return all;
}

// Red by red, each with every green and blue: 2^24 colours.
TEST_F(Twins, ReadEveryColourAlike) {
  const Cut cut = cut_of({1500, 130}, HueRule{});
  constexpr int kN = 65536;
  Bytes rgb(3 * kN), skin(kN), skin_fast(kN);
  std::vector<std::uint32_t> columns(kN), columns_fast(kN);
  for (int r = 0; r < 256; ++r) {
    for (int i = 0; i < kN; ++i) {
      rgb[at(3 * i)] = static_cast<std::uint8_t>(r);
      rgb[at(3 * i + 1)] = static_cast<std::uint8_t>(i >> 8);
      rgb[at(3 * i + 2)] = static_cast<std::uint8_t>(i & 255);
    }
    plain.read_rows({rgb.data(), kN, 1}, kN, kBins, cut, columns.data(), skin.data());
    fast.read_rows({rgb.data(), kN, 1}, kN, kBins, cut, columns_fast.data(), skin_fast.data());
    ASSERT_EQ(skin, skin_fast) << r;
    ASSERT_EQ(columns, columns_fast) << r;
    columns.assign(kN, 0U);
    columns_fast.assign(kN, 0U);
  }
}

// Colours that lie on the edges of sextants, and near them, among the others.
Bytes edgy(int n, std::uint32_t seed) {
  Bytes rgb = noise(3 * n, seed);
  for (int i = 0; i + 2 < 3 * n; i += 3) {
    if (i % 2 == 0) rgb[at(i + i % 3)] = rgb[at(i + (i + 1) % 3)];
    if (i % 5 == 0) rgb[at(i + 2)] = rgb[at(i + 1)];
    if (i % 7 == 0) rgb[at(i)] = rgb[at(i + 1)];
  }
  return rgb;
}

TEST_F(Twins, KnowEveryArcAlike) {
  constexpr int kN = 4096;
  const Bytes rgb = edgy(kN, 1);
  for (const HueRule& rule : {HueRule{}, HueRule{0, 0}, HueRule{255, 255}, HueRule{40, 128}})
    for (const Arc& arc : arcs()) {
      const Cut cut = cut_of(arc, rule);
      Bytes skin(kN), skin_fast(kN);
      std::vector<std::uint32_t> columns(kN), columns_fast(kN);
      plain.read_rows({rgb.data(), kN, 1}, kN, kBins, cut, columns.data(), skin.data());
      fast.read_rows({rgb.data(), kN, 1}, kN, kBins, cut, columns_fast.data(), skin_fast.data());
      EXPECT_EQ(skin, skin_fast) << arc.first << " " << arc.count;
      EXPECT_EQ(columns, columns_fast);
      for (int i = 0; i < kN; ++i) {
        const int hue = hue_of(rgb[at(3 * i)], rgb[at(3 * i + 1)], rgb[at(3 * i + 2)], rule);
        ASSERT_EQ(skin[at(i)] != 0, arc.has(hue)) << arc.first << " " << arc.count << " hue " << hue;
      }
    }
}

TEST_F(Twins, AgreeAtEveryWidth) {
  const Cut cut = cut_of({1450, 200}, HueRule{});
  for (int n = 0; n <= 100; ++n) {
    const Bytes rgb = noise(3 * n, static_cast<std::uint32_t>(n)), a = mask(n, 1), b = mask(n, 2),
                c = mask(n, 3);
    for (const int bins : {kBins, 5}) {
      Bytes skin(at(n)), skin_fast(at(n));
      std::vector<std::uint32_t> columns(at(n), 7U), columns_fast(at(n), 7U);
      plain.read_rows({rgb.data(), n, 1}, n, bins, cut, columns.data(), skin.data());
      fast.read_rows({rgb.data(), n, 1}, n, bins, cut, columns_fast.data(), skin_fast.data());
      EXPECT_EQ(skin, skin_fast) << n;
      EXPECT_EQ(columns, columns_fast) << n;
    }
    Bytes row = b, row_fast = b;
    plain.and_row(a.data(), n, row.data());
    fast.and_row(a.data(), n, row_fast.data());
    EXPECT_EQ(row, row_fast) << n;
    plain.join_row(a.data(), b.data(), c.data(), n, row.data());
    fast.join_row(a.data(), b.data(), c.data(), n, row_fast.data());
    EXPECT_EQ(row, row_fast) << n;
    Bytes sums = noise(n, 4), sums_fast = sums;
    using Rows = std::pair<const std::uint8_t*, const std::uint8_t*>;
    for (const auto& [add, drop] :
         {Rows{a.data(), b.data()}, Rows{nullptr, c.data()}, Rows{a.data(), nullptr}}) {
      plain.slide(add, drop, n, sums.data());
      fast.slide(add, drop, n, sums_fast.data());
      EXPECT_EQ(sums, sums_fast) << n;
    }
  }
}

TEST_F(Twins, FindTheSameMajority) {
  for (const int side : {1, 3, 5, 9, kMostMedian})
    for (int n = 1; n <= 80; n += 3) {
      const Bytes sums = noise(n + side, static_cast<std::uint32_t>(n + side), side);
      Bytes out(at(n)), out_fast(at(n));
      plain.majority_row(sums.data(), n, side, out.data());
      fast.majority_row(sums.data(), n, side, out_fast.data());
      EXPECT_EQ(out, out_fast) << side << " " << n;
    }
}

// Histograms of tiles of 225 px at most, whose bins fill a byte.
TEST_F(Twins, MatchAlike) {
  std::mt19937 random(5);
  for (const int pixels : {1, 5, 25, 225})
    for (int n = 0; n <= 21; ++n) {
      const auto histogram = [&] {
        std::uint64_t sum = 0;
        const auto many = random() % static_cast<std::uint32_t>(pixels + 1);
        const auto bins = 1 + random() % 8;
        for (std::uint32_t i = 0; i < many; ++i) sum += std::uint64_t{1} << (8 * (random() % bins));
        return sum;
      };
      std::vector<std::uint64_t> seen, model;
      for (int i = 0; i < n; ++i) {
        seen.push_back(histogram());
        model.push_back(i % 3 == 0 ? seen.back() : histogram());
      }
      for (const int need : {0, 1, (pixels + 1) / 2, pixels, pixels + 1}) {
        Bytes found(at(n)), found_fast(at(n));
        plain.match_row(seen.data(), model.data(), n, pixels, need, found.data());
        fast.match_row(seen.data(), model.data(), n, pixels, need, found_fast.data());
        EXPECT_EQ(found, found_fast) << pixels << " " << n << " " << need;
      }
    }
}

// Frames of the background in other light, and noise; limits from none to all.
TEST_F(Twins, SeeTheSameChange) {
  std::mt19937 random(7);
  const auto word = [&](std::uint32_t most) { return static_cast<std::uint16_t>(random() % (most + 1)); };
  for (int round = 0; round < 400; ++round) {
    const int n = 1 + round % 131;
    const Bytes red = noise(n, random() % 99), green = noise(n, 1), blue = noise(n, 2), still = noise(n, 3);
    Bytes rgb = noise(3 * n, static_cast<std::uint32_t>(round));
    for (int i = 0; i < n && round % 2 == 0; ++i) {
      rgb[at(3 * i)] = static_cast<std::uint8_t>(red[at(i)] - red[at(i)] / 8);
      rgb[at(3 * i + 1)] =
          static_cast<std::uint8_t>(green[at(i)] - green[at(i)] / 8 + (i % 5 == 0 ? i % 3 : 0));
      rgb[at(3 * i + 2)] = static_cast<std::uint8_t>(blue[at(i)] - blue[at(i)] / 8);
    }
    std::vector<std::uint16_t> side;
    for (int i = 0; i < n; ++i) side.push_back(word(round % 3 == 0 ? 65535 : 20000));
    const ChangeRow row{rgb.data(), red.data(), green.data(), blue.data(), still.data(), side.data()};
    const std::uint32_t most = round % 7 == 0 ? 65535U : 3000U;
    const FrameLight light{
        {word(8192), word(8192), 896}, {word(256), word(256), 256}, word(most), word(most), word(most)};
    const HueRule rule{static_cast<std::uint8_t>(round % 5 == 0 ? 40 : 1),
                       static_cast<std::uint8_t>(round % 5 == 0 ? 60 : 0)};
    const Cut cut = cut_of({word(1535), 768 + word(768)}, rule);
    Bytes strong(at(n)), skin(at(n)), hueless(at(n)), strong_fast(at(n)), skin_fast(at(n)),
        hueless_fast(at(n));
    plain.change_row(row, n, light, cut, strong.data(), skin.data(), hueless.data());
    fast.change_row(row, n, light, cut, strong_fast.data(), skin_fast.data(), hueless_fast.data());
    ASSERT_EQ(skin, skin_fast) << round;
    ASSERT_EQ(strong, strong_fast) << round;
    ASSERT_EQ(hueless, hueless_fast) << round;
  }
}

// Hue in integers: the corners of the circle, its one formula, colours without hue; and arcs that reach over
// red.

constexpr HueRule kAll{1, 0};

TEST(Hue, OfTheSixCornersIsAMultipleOfASextant) {
  EXPECT_EQ(hue_of(255, 0, 0, kAll), 0);
  EXPECT_EQ(hue_of(200, 200, 0, kAll), 256);
  EXPECT_EQ(hue_of(0, 9, 0, kAll), 512);
  EXPECT_EQ(hue_of(10, 200, 200, kAll), 768);
  EXPECT_EQ(hue_of(0, 0, 255, kAll), 1024);
  EXPECT_EQ(hue_of(255, 0, 255, kAll), 1280);
  EXPECT_EQ(hue_of(255, 0, 1, kAll), 1534);  // 254 of 255 from magenta to red
  EXPECT_EQ(hue_of(255, 1, 0, kAll), 1);
}

// The floor of the usual formula, in steps of 7 of each channel.
TEST(Hue, IsTheFloorOfTheUsualOne) {
  for (int r = 0; r < 256; r += 7)
    for (int g = 0; g < 256; g += 7)
      for (int b = 0; b < 256; b += 7) {
        const int most = std::max(r, std::max(g, b)), chroma = most - std::min(r, std::min(g, b));
        if (chroma == 0) continue;
        double turn = r == most ? static_cast<double>(g - b) / chroma
                                : (g == most ? 2.0 + static_cast<double>(b - r) / chroma
                                             : 4.0 + static_cast<double>(r - g) / chroma);
        if (turn < 0.0) turn += 6.0;
        EXPECT_EQ(hue_of(r, g, b, kAll), static_cast<int>(256.0 * turn + 1e-9) % kHues)
            << r << " " << g << " " << b;
      }
}

TEST(Hue, GreyAndDarkPixelsHaveNone) {
  const HueRule rule{};
  for (int v = 0; v < 256; ++v) EXPECT_EQ(hue_of(v, v, v, HueRule{0, 0}), kNoHue) << v;
  EXPECT_EQ(hue_of(100 + rule.least_chroma - 1, 100, 100, rule), kNoHue);
  EXPECT_EQ(hue_of(100 + rule.least_chroma, 100, 100, rule), 0);
  EXPECT_EQ(hue_of(rule.least_value - 1, 0, 0, rule), kNoHue);
  EXPECT_EQ(hue_of(rule.least_value, 0, 0, rule), 0);
}

TEST(Arc, ReachesOverRed) {
  const double step = 2.0 * std::numbers::pi / kHues;
  const Arc arc = skin_arc({.hue = 2.0 * std::numbers::pi, .spread = 100.0 * step}, 2.0);  // +-200 about red
  EXPECT_EQ(arc.first, kHues - 200);
  EXPECT_EQ(arc.count, 400);
  for (const int in : {1336, 1535, 0, 199}) EXPECT_TRUE(arc.has(in)) << in;
  for (const int out : {1335, 200, 768, kNoHue}) EXPECT_FALSE(arc.has(out)) << out;
  const Arc same = skin_arc({.hue = 0.0, .spread = 100.0 * step}, 2.0);
  EXPECT_EQ(same.first, arc.first);
  EXPECT_EQ(same.count, arc.count);
}

TEST(Arc, IsTheWholeCircleOrNothingAtTheEnds) {
  EXPECT_EQ(skin_arc({1.0, 1.0}, 3.2).count, kHues);
  EXPECT_EQ(skin_arc({1.0, 1e-9}, 1.0).count, 0);
  EXPECT_FALSE(skin_arc({1.0, 1.0}, 9.0).has(kNoHue));  // grey is no skin for any arc
}

// The median of a mask: against a count of each window, and its two promises.

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
  for (int y = 0; y < 48; y += 3)  // no pixel has another among its eight neighbours; corners and edges, too
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
