// Seeds of what vision is judged by: none of a user's reaches those that nobody looked at.
#include "benchmarks/staged/staged.h"

#include <gtest/gtest.h>

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
