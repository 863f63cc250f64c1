// Hue in integers: the corners of the circle, its one formula, what has none; and arcs that reach over red.
#include "core/vision/segmentation/kernels/hue.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/vision/segmentation/kernels/arc.h"

namespace enc::segmentation {
namespace {

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

// Against the usual formula, in steps of 7 of each channel: the floor of it.
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
  EXPECT_FALSE(skin_arc({1.0, 1.0}, 9.0).has(kNoHue));  // whatever the arc, grey is no skin
}

}  // namespace
}  // namespace enc::segmentation
