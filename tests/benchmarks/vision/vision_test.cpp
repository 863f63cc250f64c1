// Seeds of the vision benchmarks: a user's seed never selects the held-out sets. Also the intervals of pixel
// shares in a report.
#include <gtest/gtest.h>

#include "benchmarks/segmentation/pairs.h"
#include "benchmarks/staged/staged.h"
#include "core/base/error.h"

namespace enc::bench::staged {
namespace {

BenchContext context_of(std::uint64_t seed) {
  BenchContext context;
  context.seed = seed;
  return context;
}

TEST(Seeds, ThoseThatNobodyLookedAtAreKept) {
  EXPECT_EQ(test_seed(context_of(1)), kTest + 1000);
  std::uint64_t most = 1;
  for (std::uint64_t step = 1U << 30U; step > 0; step /= 2) {
    bool refused = false;
    try {
      static_cast<void>(test_seed(context_of(most + step)));
    } catch (const Error& e) {
      refused = true;
      EXPECT_NE(std::string(e.what()).find("at most"), std::string::npos) << e.what();
    }
    if (!refused) most += step;
  }
  EXPECT_GT(most, 100'000U);
  EXPECT_LT(test_seed(context_of(most)) + 999, kNeverSeen);
  EXPECT_THROW(static_cast<void>(test_seed(context_of(UINT64_MAX))), Error);
}

TEST(Staged, ATipBesideTheCapIsNoneThatWasFoundBadly) {
  sim::PixelTruth truth;
  truth.radius = 7.5;
  EXPECT_EQ(within_cap(truth), 7.5);
  truth.radius = 1.0;
  EXPECT_EQ(within_cap(truth), 2.0);
}

}  // namespace
}  // namespace enc::bench::staged

namespace enc::bench::segmentation {
namespace {

// Student's t over few pairs can exceed the possible range: 100 +- 0.3 % of the pixels would be more than
// all.
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
