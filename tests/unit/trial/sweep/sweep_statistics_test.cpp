// Statistics of a sweep: intervals and main effects.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "trial/sweep/statistics.h"

namespace enc::trial {
namespace {

TEST(SweepStatistics, TheIntervalIsStudents) {
  std::vector<double> values;
  for (int i = 1; i <= 11; ++i) values.push_back(i);
  values.push_back(std::numeric_limits<double>::quiet_NaN());
  const Summary s = summary_of(values);
  EXPECT_EQ(s.n, 11U);
  EXPECT_EQ(s.mean, 6.0);
  EXPECT_NEAR(s.sd, std::sqrt(11.0), 1e-12);
  EXPECT_NEAR(s.half, 2.228139, 1e-3);  // t of 10 degrees of freedom, as sd / sqrt(n) is 1
  EXPECT_EQ(s.median, 6.0);
  EXPECT_TRUE(std::isnan(s.p95)) << "a percentile of 95 % needs 20 values";
}

TEST(SweepStatistics, AnEffectIsTheShareBetweenTheLevels) {
  std::vector<std::string> a, b;
  std::vector<double> values;
  for (int i = 0; i < 64; ++i) {
    a.push_back(std::to_string(i % 4));
    b.push_back(i / 4 % 2 == 0 ? "none" : "observed");
    values.push_back(3.0 * (i % 4));
  }
  const Effect of_a = effect_of(a, values), of_b = effect_of(b, values);
  ASSERT_EQ(of_a.levels.size(), 4U);
  EXPECT_EQ(of_a.levels[3].x, 3.0);
  EXPECT_EQ(of_a.levels[3].summary.mean, 9.0);
  EXPECT_NEAR(of_a.share, 1.0, 1e-12);
  ASSERT_EQ(of_b.levels.size(), 2U);
  EXPECT_EQ(of_b.levels[1].name, "observed");
  EXPECT_NEAR(of_b.share, 0.0, 1e-12);
}

// 1.001 has no exact sum in binary.
TEST(SweepStatistics, EqualValuesHaveNoSpreadAndNoEffect) {
  const std::vector<double> values(16, 1.001);
  EXPECT_EQ(summary_of(values).mean, 1.001);
  EXPECT_EQ(summary_of(values).sd, 0.0);
  std::vector<std::string> parameter(8, "3");
  parameter.resize(16, "5");
  EXPECT_TRUE(std::isnan(effect_of(parameter, values).share));
}

TEST(SweepStatistics, ARangeIsCutIntoEqualParts) {
  std::vector<std::string> x;
  std::vector<double> values;
  for (int i = 0; i < 80; ++i) {
    x.push_back(std::to_string(79 - i));
    values.push_back(79 - i);
  }
  const Effect effect = effect_of(x, values);
  ASSERT_EQ(effect.levels.size(), 8U);
  EXPECT_EQ(effect.levels[0].summary.n, 10U);
  EXPECT_EQ(effect.levels[0].x, 4.5);
  EXPECT_GT(effect.share, 0.98);
}

}  // namespace
}  // namespace enc::trial
