// Bad [user.session] tables: one line each, which says what is wrong and what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string said_session(const std::vector<std::string>& set, const std::string& scene = "session") {
  try {
    (void)trial::prepare_setup(models::load(scene_file(scene), "sim", set));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(SessionInput, TheShippedSceneIsReady) { EXPECT_EQ(said_session({}), ""); }

TEST(SessionInput, NumbersOutOfRange) {
  for (const char* set : {"user.session.duration_s=0",
                          "user.session.polar_max_deg=90",
                          "user.session.polar_max_deg=-1",
                          "user.session.tilt_deg=[-1,20]",
                          "user.session.tilt_deg=[0,61]",
                          "user.session.reach_mm=[0,60]",
                          "user.session.peak_mm_s=[0,100]",
                          "user.session.touch_mm_s=[-1,100]",
                          "user.session.depth_mm=[0,6]",
                          "user.session.press_mm_s=[0,6]",
                          "user.session.hold_s=[-1,1]",
                          "user.session.rest_s=[-1,1]",
                          "user.session.change_share=[0.4,1.1]",
                          "user.session.tray_mm=[0,0]",
                          "truth.hand.primary_share=0",
                          "truth.hand.primary_scatter=-1",
                          "truth.hand.aside_scatter=-1",
                          "truth.hand.submovement_min_ms=0",
                          "truth.hand.aborted=1.1",
                          "truth.hand.tremor_band_hz=-1",
                          "user.tremor=waves"})
    EXPECT_THAT(said_session({set}), AllOf(HasSubstr("expected"), Not(HasSubstr("\n")))) << set;
}

TEST(SessionInput, PairsAreLeastAndMost) {
  for (const char* key : {"tilt_deg", "reach_mm", "peak_mm_s", "touch_mm_s", "depth_mm", "press_mm_s",
                          "hold_s", "rest_s", "change_share"}) {
    const std::string name = std::string("user.session.").append(key);
    EXPECT_THAT(said_session({name + "=[0.9, 0.5]"}),
                AllOf(HasSubstr(key), HasSubstr("its first number above")));
    EXPECT_THAT(said_session({name + "=[0.5]"}),
                AllOf(HasSubstr(key), HasSubstr("has 1 number; expected the least")));
    EXPECT_THAT(said_session({name + "=[0.1, 0.2, 0.3]"}), HasSubstr("has 3 numbers"));
  }
}

TEST(SessionInput, KindAndTableBelongTogether) {
  EXPECT_THAT(said_session({"user.kind=press_release"}),
              AllOf(HasSubstr("there is a [user.session]"), HasSubstr("expected")));
  EXPECT_THAT(said_session({"user.kind=session"}, "tennis_ball"),
              AllOf(HasSubstr("there is no [user.session]"), HasSubstr("add the table")));
}

TEST(SessionInput, ToolsAndPlaces) {
  EXPECT_THAT(said_session({"user.session.other_tool=prob"}),
              AllOf(HasSubstr("there is no tool"), HasSubstr("probe")));
  EXPECT_THAT(said_session({"user.session.other_tool=stylus"}), HasSubstr("which is held already"));
  EXPECT_THAT(said_session({"user.session.tray_mm=[-80,0,0]"}),
              AllOf(HasSubstr("'tray_mm' is"), HasSubstr("pause_mm")));
  // By whichever object: the machine follows a tool to the nearest one. And by the second tool's place beside
  // it.
  EXPECT_THAT(said_session({"user.session.tray_mm=[-150,0,60]"}, "training"),
              AllOf(HasSubstr("'tray_mm' is 68 mm from the surface of 'bone'"), HasSubstr("pause_mm")));
  EXPECT_THAT(said_session({"user.session.tray_mm=[0,-150,0]"}), HasSubstr("the other tool's place"));
  EXPECT_THAT(said_session({"user.push_N=3"}), HasSubstr("expected no 'push_N'"));
  EXPECT_THAT(said_session({"user.session.polar_max_dge=3"}), HasSubstr("polar_max_deg"));
}

}  // namespace
}  // namespace enc::test
