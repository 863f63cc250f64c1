// Bad [user.reaches] tables: one line each, which says what is wrong and what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string said_reaching(const std::vector<std::string>& set, const std::string& scene = "reaching") {
  try {
    (void)trial::prepare_setup(models::load(scene_file(scene), "", set));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(ReachesInput, TheShippedSceneIsReady) { EXPECT_EQ(said_reaching({}), ""); }

TEST(ReachesInput, NumbersOutOfRange) {
  for (const char* set : {"user.reaches.count=0", "user.reaches.spread_mm=0", "user.reaches.polar_max_deg=90",
                          "user.reaches.tilt_deg=[0, 70]", "user.reaches.touch_mm_s=[0, 10]"})
    EXPECT_THAT(said_reaching({set}), HasSubstr("expected")) << set;
}

TEST(ReachesInput, PairsAreLeastAndMost) {
  for (const char* key :
       {"tilt_deg", "reach_mm", "peak_mm_s", "touch_mm_s", "depth_mm", "press_mm_s", "hold_s", "rest_s"}) {
    const std::string name = std::string("user.reaches.").append(key);
    EXPECT_THAT(said_reaching({name + "=[0.9, 0.5]"}),
                AllOf(HasSubstr(key), HasSubstr("its first number above")));
    EXPECT_THAT(said_reaching({name + "=[0.5]"}), AllOf(HasSubstr(key), HasSubstr("has 1 number;")));
  }
}

TEST(ReachesInput, KindAndTableBelongTogether) {
  EXPECT_THAT(said_reaching({"user.kind=press_release"}),
              AllOf(HasSubstr("there is a [user.reaches]"), HasSubstr("remove the table")));
  EXPECT_THAT(said_reaching({"user.kind=reaches"}, "wall"),
              AllOf(HasSubstr("there is no [user.reaches]"), HasSubstr("add the table")));
  EXPECT_THAT(said_reaching({"user.push_N=3"}), HasSubstr("expected no 'push_N'"));
}

TEST(ReachesInput, AReachBeginsWhereTheFingerIsAway) {
  EXPECT_THAT(said_reaching({"user.reaches.reach_mm=[50, 100]"}),
              AllOf(HasSubstr("'follow.pause_mm', 120 mm"), HasSubstr("raise it")));
}

}  // namespace
}  // namespace enc::test
