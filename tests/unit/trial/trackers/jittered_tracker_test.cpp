// Results that come at irregular times: what is told, when, and what of it is felt.
#include "trial/trackers/jittered_tracker.h"

#include <vector>

#include <gtest/gtest.h>

#include "trial/trackers/frame_times.h"

namespace enc::trial {
namespace {

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }
constexpr Duration kPeriod{50'000'000}, kLatency{50'000'000};

// A frame each 50 ms, there as soon as it is exposed; its number is the tool's.
class Frames final : public PoseTracker {
 public:
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    if (!exposures_.due(now)) return false;
    newest = {{static_cast<std::int32_t>(exposures_.n - 1), {}}, now, Health::ok};
    return true;
  }

 private:
  Every exposures_{20.0};
};

struct Told {
  std::int32_t frame;
  double age;  // s
};
std::vector<Told> told(Duration jitter, std::uint64_t seed, int ms = 20'000) {
  JitteredTracker tracker(std::make_unique<Frames>(), {kLatency, jitter, seed});
  std::vector<Told> all;
  Stamped<TrackedTool> newest;
  for (int i = 0; i < ms; ++i) {
    if (!tracker.poll(at_ms(i), newest)) continue;
    EXPECT_EQ(newest.t, Time(kPeriod * newest.value.tool));  // the stamp stays true
    all.push_back({newest.value.tool, age(at_ms(i), newest.t)});
  }
  return all;
}

TEST(JitteredTracker, WithoutJitterEachComesWhenItIsDue) {
  const auto all = told({}, 1);
  ASSERT_EQ(all.size(), 399U);
  for (const Told& t : all) EXPECT_DOUBLE_EQ(t.age, 0.050);
}

// Early at the exposure, late when the next but one is exposed; in order, and as often one as the other.
TEST(JitteredTracker, OneFrameEarlyOrLateInOrderAndRepeatable) {
  const auto all = told(kPeriod, 7), again = told(kPeriod, 7), other = told(kPeriod, 8);
  ASSERT_EQ(all.size(), again.size());
  double least = 1.0, most = 0.0, sum = 0.0, differs = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].age, again[i].age);
    EXPECT_TRUE(i == 0 || all[i].frame > all[i - 1].frame);
    if (i < other.size()) differs += std::abs(all[i].age - other[i].age);
    least = std::min(least, all[i].age);
    most = std::max(most, all[i].age);
    sum += all[i].age;
  }
  EXPECT_LT(least, 0.005);
  EXPECT_GT(most, 0.095);
  EXPECT_LE(most, 0.101);
  EXPECT_NEAR(sum / static_cast<double>(all.size()), 0.055, 0.01);
  EXPECT_GT(differs, 1.0);
}

TEST(FrameTimes, AStaleFrameIsNoFrameAndTheRateIsThatOfTheHandOvers) {
  FrameTimes times;
  times.reserve(10);
  Stamped<TrackedTool> tool;
  times.see(at_ms(0), tool);
  EXPECT_EQ(times.frames, 0);
  for (int i = 0; i < 200; ++i) {
    if (i % 50 == 0) tool = {{}, at_ms(i), i == 150 ? Health::stale : Health::ok};
    if (i == 150) tool.t = at_ms(100);  // told again
    times.see(at_ms(i + 30), tool);
  }
  EXPECT_EQ(times.frames, 3);
  EXPECT_DOUBLE_EQ(times.rate(), 20.0);
  EXPECT_EQ(times.intervals, (std::vector<double>{0.050, 0.050}));
  EXPECT_EQ(times.ages, (std::vector<double>{0.030, 0.030, 0.030}));
}

}  // namespace
}  // namespace enc::trial
