// Ways that are timed in turn, and what they cost beside how wrong they are.
#include "benchmarks/kit/cost.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace enc::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

volatile double sink = 1.0;  // so that the work is done
void work(int n) {
  for (int i = 0; i < n; ++i) sink = sink * 0.5 + 1.0;
}

TEST(Race, EachRunsOnceARoundAndTheFirstIsAlone) {
  std::string order;
  const Race race(20, {[&] { order += 'a'; }, [&] { order += 'b'; }, [&] { order += 'c'; }});
  ASSERT_THAT(order, SizeIs(3 * 21));
  std::string firsts;
  for (std::size_t i = 0; i < order.size(); i += 3) {
    std::string round = order.substr(i, 3);
    firsts += round[0];
    std::sort(round.begin(), round.end());
    EXPECT_EQ(round, "abc");
  }
  for (const char way : {'a', 'b', 'c'}) EXPECT_GT(std::count(firsts.begin(), firsts.end(), way), 1) << way;
}

TEST(Race, WhatCostsFourTimesAsMuchIsSeen) {
  const Race race(31, {[] { work(20'000); }, [] { work(80'000); }});
  EXPECT_GT(race.seconds(0), 0.0);
  EXPECT_NEAR(race.ratio(1, 0), 4.0, 1.0);
  EXPECT_DOUBLE_EQ(race.ratio(0, 0), 1.0);
}

TEST(Race, RoundsBeforeTheFirstAreNotTimedAndChunksBeginAnew) {
  std::vector<std::size_t> done;
  const Race race(3, {in_chunks(6, 2, [&](std::size_t i) { done.push_back(i); })}, 2);
  EXPECT_THAT(done, ElementsAre(0, 1, 2, 3, 4, 5, 0, 1, 2, 3));
  const Race other(3, {[] {}}, 0);
  EXPECT_GT(race.ratio(0, other, 0), 0.0);
  EXPECT_THROW((void)race.ratio(0, Race(2, {[] {}}), 0), std::out_of_range);  // not as many rounds
}

// Said of one sample: what means of many samples scatter by.
TEST(TrimmedMean, SaysHowWellItIsKnown) {
  std::mt19937_64 random(7);
  for (const double share_of_outliers : {0.0, 0.01}) {
    std::vector<double> means, doubts;
    for (int sample = 0; sample < 400; ++sample) {
      std::vector<double> numbers(120);
      for (double& number : numbers) {
        number = std::normal_distribution(3.0, 0.5)(random);
        if (std::bernoulli_distribution(share_of_outliers)(random)) number *= 20.0;
      }
      const TrimmedMean of = trimmed_mean(std::move(numbers));
      means.push_back(of.mean);
      doubts.push_back(of.doubt);
    }
    double mean = 0.0, scatter = 0.0, doubt = 0.0;
    for (const double one : means) mean += one / 400.0;
    for (const double one : means) scatter += (one - mean) * (one - mean) / 399.0;
    for (const double one : doubts) doubt += one / 400.0;
    EXPECT_NEAR(doubt / std::sqrt(scatter), 1.0, 0.15) << share_of_outliers;
  }
}

TEST(Race, TellsHowMuchLongerARoundTook) {
  const auto work = [](int times) {
    return [times] {
      volatile double x = 1.0;
      for (int i = 0; i < times * 20'000; ++i) x = x * 0.999 + 0.001;
    };
  };
  const Race race(40, {work(1), work(3), work(1)});
  EXPECT_NEAR(race.more(1, 0) / race.seconds(0), 2.0, 1.0);
  EXPECT_NEAR(race.more(2, 0) / race.seconds(0), 0.0, 0.5);
  EXPECT_DOUBLE_EQ(race.more(0, 0), 0.0);
}

TEST(Order, IsFittedAboveTheFloorAlone) {
  const std::vector<double> steps{8.0, 4.0, 2.0, 1.0};
  EXPECT_NEAR(fitted_order(steps, {8.0, 4.0, 2.0, 1.0}, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(fitted_order(steps, {4096.0, 256.0, 16.0, 3.0}, 2.0), 4.0, 1e-12) << "the last is at the floor";
  EXPECT_TRUE(std::isnan(fitted_order(steps, {8.0, 4.0, 2.0, 1.0}, 1.0))) << "two points are no fit";
  EXPECT_NEAR(fitted_order(steps, {8.0, kUnset, 2.0, 1.0}, 0.0), 1.0, 1e-12) << "a failure is no point";
}

TEST(Cost, WhatFailedIsACrossAndWhatNeverRanIsNothing) {
  const Plot plot = cost_beside_error(
      {.id = "cost", .title = "Cost", .x_label = "time (s)", .y_label = "error (um)"},
      {{"good", {1.0, 2.0}, {0.2, 0.1}}, {"bad", {1.0, kUnset, 3.0}, {kUnset, kUnset, 0.5}}});
  EXPECT_TRUE(plot.log_x && plot.log_y);
  ASSERT_THAT(plot.series, SizeIs(3));
  EXPECT_EQ(plot.series[0].name, "good");
  EXPECT_THAT(plot.series[0].x, ElementsAre(1.0, 2.0));
  EXPECT_THAT(plot.series[0].y, ElementsAre(0.2, 0.1));
  EXPECT_THAT(plot.series[1].x, ElementsAre(3.0));
  EXPECT_EQ(plot.series[2].mark, Mark::crosses);
  EXPECT_THAT(plot.series[2].name, IsEmpty());
  EXPECT_THAT(plot.series[2].x, ElementsAre(1.0));
}

}  // namespace
}  // namespace enc::bench
