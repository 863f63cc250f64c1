// What a report says of shares of pixels.
#include "benchmarks/segmentation/score.h"

#include <gtest/gtest.h>

namespace enc::bench::segmentation {
namespace {

// Student's t over few pairs is wider than what there is: 100 +- 0.3 % of the pixels are not more than all.
TEST(SegmentationScore, AnIntervalOfSharesStaysAmongShares) {
  const Mean high{.value = 0.999, .half = 0.003}, low{.value = 0.0002, .half = 0.0005};
  EXPECT_DOUBLE_EQ(in_percent(high).least, 99.6);
  EXPECT_DOUBLE_EQ(in_percent(high).most, 100.0);
  EXPECT_DOUBLE_EQ(in_percent(low).least, 0.0);
  EXPECT_DOUBLE_EQ(in_percent(low).most, 0.07);
  EXPECT_EQ(interval_text(high), "99.60..100.00");
  EXPECT_EQ(interval_text(low, 3), "0.000..0.070");
  const Mean inside{.value = 0.5, .half = 0.1};
  EXPECT_DOUBLE_EQ(ends(inside).least, 0.4);
  EXPECT_DOUBLE_EQ(ends(inside).most, 0.6);
}

// One pair has no interval.
TEST(SegmentationScore, OnePairAloneHasNone) {
  const Mean one{.value = 0.98, .half = kUnset};
  EXPECT_DOUBLE_EQ(in_percent(one).middle, 98.0);
  EXPECT_TRUE(std::isnan(in_percent(one).least));
  EXPECT_EQ(interval_text(one), "not known");
}

}  // namespace
}  // namespace enc::bench::segmentation
