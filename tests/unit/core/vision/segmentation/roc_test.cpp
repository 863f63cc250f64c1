// Counts of what was found and of what is there; an ROC whose rates grow with what is let through.
#include "core/vision/segmentation/roc.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc {
namespace {

TEST(Roc, CountsWhatIsFoundAndWhatIsThere) {
  Mask found(5, 2), truth(5, 2);
  found.on = {255, 255, 255, 0, 0, 0, 0, 0, 0, 0};
  truth.on = {255, 255, 0, 255, 0, 0, 0, 0, 0, 0};
  const Confusion c = compare(found, truth);
  EXPECT_EQ(c.true_positive, 2);
  EXPECT_EQ(c.false_positive, 1);
  EXPECT_EQ(c.false_negative, 1);
  EXPECT_EQ(c.true_negative, 6);
  EXPECT_DOUBLE_EQ(c.correct(), 0.8);
  EXPECT_DOUBLE_EQ(c.false_positives(), 0.1);
  EXPECT_DOUBLE_EQ(c.false_negatives(), 0.1);
  EXPECT_DOUBLE_EQ(c.iou(), 0.5);
  EXPECT_DOUBLE_EQ(c.true_positive_rate(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.false_positive_rate(), 1.0 / 7.0);
  EXPECT_EQ(compare(Mask(3, 3), Mask(3, 3)).iou(), 1.0);
  EXPECT_THROW((void)compare(Mask(3, 3), Mask(3, 2)), Error);
}

// Left half skin before blue; the right half skin in the background already.
TEST(Roc, GrowsWithBothThresholds) {
  Image background(40, 20), image(40, 20);
  Mask truth(40, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool left = x < 20;
      const std::uint8_t skin[3] = {200, static_cast<std::uint8_t>(130 + x % 4 * 10), 100};
      const std::uint8_t blue[3] = {40, 60, 180};
      std::copy(skin, skin + 3, image.at(x, y));
      std::copy(left ? blue : skin, (left ? blue : skin) + 3, background.at(x, y));
      truth.row(y)[x] = left ? 255 : 0;
    }
  SegmentationSpec spec;
  spec.model = {.hue = 0.47, .spread = 0.1};
  const SegmentationPair pair{{background.view()}, image.view(), &truth};
  const double match[] = {0.0, 0.5, 1.01}, skin[] = {0.0, 1.2, 4.0};
  const std::vector<RocPoint> points = roc(spec, {&pair, 1}, match, skin);
  ASSERT_EQ(points.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(points[i].foreground, match[i / 3]);
    EXPECT_EQ(points[i].skin, skin[i % 3]);
    EXPECT_EQ(points[i].found.pixels(), 800);
    for (const std::size_t before : {i % 3 == 0 ? i : i - 1, i < 3 ? i : i - 3}) {
      EXPECT_GE(points[i].found.true_positive_rate(), points[before].found.true_positive_rate());
      EXPECT_GE(points[i].found.false_positive_rate(), points[before].found.false_positive_rate());
    }
  }
  EXPECT_EQ(points[2].found.true_positive_rate(), 0.0);  // everything matches
  EXPECT_EQ(points[5].found.iou(), 1.0);
  EXPECT_EQ(points[8].found.false_positive_rate(), 1.0);  // nothing does
  EXPECT_LT(points[4].found.true_positive_rate(), 1.0);   // narrower than this skin is
  EXPECT_GT(points[4].found.true_positive_rate(), 0.0);
}

TEST(Roc, RefusesAPairWithoutTruthOrBackground) {
  const Image image(4, 4);
  const Mask truth(4, 4);
  SegmentationSpec spec;
  spec.model = {.hue = 0.4, .spread = 0.1};
  const double one[] = {1.0};
  for (const SegmentationPair& pair :
       {SegmentationPair{{}, image.view(), &truth}, SegmentationPair{{image.view()}, image.view(), nullptr}})
    EXPECT_THROW((void)roc(spec, {&pair, 1}, one, one), Error);
}

}  // namespace
}  // namespace enc
