// Due times are multiples, never sums.
#include "core/base/time.h"

#include <chrono>
#include <concepts>

#include <gtest/gtest.h>

namespace enc {
namespace {

template <class A, class B>
concept SubtractsTime = requires(A a, B b) {
  a - b;
};
template <class C>
concept HasNow = requires {
  C::now();
};
static_assert(!HasNow<Epoch> && !SubtractsTime<Time, std::chrono::steady_clock::time_point> &&
              SubtractsTime<Time, Time>);

TEST(Every, DoesNotDriftAt120HzOverAnHour) {
  Every every{120.0, 0, {}};
  std::int64_t due = 0;
  for (std::int64_t ms = 0; ms < 3'600'000; ++ms)
    while (every.due(Time(Duration(ms * 1'000'000)))) ++due;
  EXPECT_EQ(due, 120 * 3600);
  // Number 432,000 is due at 3600 s to the nanosecond; summing 8,333,333 ns would be 144 us early.
  EXPECT_EQ(every.next(), Time(Duration(3'600'000'000'000)));
  EXPECT_EQ((Every{120.0, 1, {}}.next()), Time(Duration(8'333'333)));
  EXPECT_EQ((Every{120.0, 2, {}}.next()), Time(Duration(16'666'667)));
}

TEST(Every, FirstIsDueAtItsPhase) {
  Every now{60.0, 0, {}};
  EXPECT_TRUE(now.due(Time{}));
  EXPECT_FALSE(now.due(Time{}));
  Every later{60.0, 0, Duration(5)};
  EXPECT_FALSE(later.due(Time(Duration(4))));
  EXPECT_TRUE(later.due(Time(Duration(5))));
}

TEST(Every, GivesEachMissedTimeOnce) {
  Every every{1000.0, 0, {}};
  int due = 0;
  while (every.due(Time(Duration(5'500'000)))) ++due;
  EXPECT_EQ(due, 6);  // 0, 1, 2, 3, 4, 5 ms
}

TEST(Every, ARateOfZeroIsNeverDue) {
  Every never;
  EXPECT_FALSE(never.due(Time(Duration(1'000'000'000))));
}

TEST(Seconds, AreTheNearestDoubleOfTheDecimal) {
  EXPECT_EQ(seconds(Duration(1'000'000'000)), 1.0);
  for (const auto& [ns, s] : {std::pair{45'000'000, 0.045},
                              {100'000'000, 0.1},
                              {5'000'000, 0.005},
                              {200'000'000, 0.2},
                              {50'000'000, 0.05}})
    EXPECT_EQ(seconds(Duration(ns)), s);  // so that an age of exactly a limit is not beyond it
  EXPECT_EQ(from_seconds(0.001), Duration(1'000'000));
  EXPECT_EQ(from_seconds(-0.0000000014), Duration(-1));
}

}  // namespace
}  // namespace enc
