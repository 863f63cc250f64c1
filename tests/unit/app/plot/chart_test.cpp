// Charts: curves of few values, and axes of any range.
#include "app/plot/chart.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/frames.h"

namespace enc::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Chart chart_of(Range x, Range y) {
  Chart chart;
  chart.width = 100.0;
  chart.height = 50.0;
  chart.x = x;
  chart.y = rounded(y);
  return chart;
}

TEST(Chart, ACurveOfFewValuesIsOneLineAndAnUnsetValueIsAGap) {
  const Chart chart = chart_of({0.0, 10.0, true}, {0.0, 10.0, true});
  const auto lines = [&](int unset) {
    Trace trace(chart);
    for (int i = 0; i <= 10; ++i) trace.add(i, i == unset ? kUnset : i);
    const std::string text = trace.text();
    return std::count(text.begin(), text.end(), 'M');
  };
  EXPECT_EQ(lines(-1), 1);
  EXPECT_EQ(lines(5), 2);
}

TEST(Chart, AnyRangeHasSomeTicks) {
  for (const double value : {0.0, 1e-30, -3.0, 1e10, -1e13, 1e17, 1e300}) {
    const Chart chart = chart_of({0.0, 1.0, true}, {value, value, true});
    EXPECT_LT(chart.y.least, chart.y.most) << value;
    EXPECT_TRUE(chart.y.least <= value && value <= chart.y.most) << value;
    const std::string text = axes(chart, "c");
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    const auto ticks = std::count(text.begin(), text.end(), 'H') - 1;  // the frame has one, too
    EXPECT_TRUE(ticks >= 2 && ticks <= 12) << value << ": " << ticks;
  }
}

}  // namespace
}  // namespace enc::app
