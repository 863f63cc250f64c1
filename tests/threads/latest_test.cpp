// One thread writes and one reads, as fast as they can.
#include "core/base/latest.h"

#include <algorithm>
#include <array>
#include <thread>

#include <gtest/gtest.h>

namespace enc {
namespace {

// Too long to be copied at once: one that is torn has two numbers in it.
struct Long {
  std::array<std::int64_t, 32> same{};
  [[nodiscard]] bool whole() const {
    return std::all_of(same.begin(), same.end(), [this](std::int64_t n) { return n == same[0]; });
  }
};

TEST(LatestOfTwoThreads, IsWholeAndNeverGoesBackAndEndsWithTheLast) {
  constexpr std::int64_t kWrites = 300'000;
  Latest<Long> latest;
  std::atomic<bool> reads = false, over = false;
  std::thread writer([&] {
    while (!reads) std::this_thread::yield();
    Long value;
    for (std::int64_t n = 1; n <= kWrites; ++n) {
      value.same.fill(n);
      latest.write(value);
    }
    over = true;
  });
  std::int64_t last = 0, torn = 0, older = 0, read = 0;
  Long value;
  for (bool end = false; !end;) {
    reads = true;
    end = over;  // before the last look
    while (latest.read(value)) {
      ++read;
      torn += value.whole() ? 0 : 1;
      older += value.same[0] <= last ? 1 : 0;
      last = value.same[0];
    }
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(older, 0);
  EXPECT_EQ(last, kWrites);
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace enc
