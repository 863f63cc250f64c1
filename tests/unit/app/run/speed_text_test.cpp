// How fast a run went, as its report prints it.
#include <gtest/gtest.h>

#include "app/run/run_report.h"

namespace enc::app {
namespace {

TEST(SpeedText, ASlowRunHasTwoDigits) {
  EXPECT_EQ(speed_text(1.0, 12.5), "0.08");
  EXPECT_EQ(speed_text(24.0, 10.0), "2.4");
  EXPECT_EQ(speed_text(84.45, 0.553), "153");
  EXPECT_EQ(speed_text(1.0, 0.0), "0");
}

}  // namespace
}  // namespace enc::app
