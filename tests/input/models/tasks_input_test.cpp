// Bad tables of tasks ([pusher], [user.reaches], [user.session]), limits and tools: one line refuses each
// with the mistake and the remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/error_of.h"
#include "tests/support/twin.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// ---- Bad [pusher] tables: one line each. The program refuses a stiffness below the minimum of the loop
// unless the user requests it.

// The error message of the scene `stiffness` with these settings; empty if prepare() accepts it.
std::string said_of(const std::vector<std::string>& set, const std::string& scene = "stiffness") {
  return error_of([&] { (void)trial::prepare_setup(models::load(scene_file(scene), "sim", set)); });
}

TEST(PusherInput, TheShippedSceneIsReady) { EXPECT_EQ(said_of({}), ""); }

TEST(PusherInput, NumbersOutOfRange) {
  for (const char* set :
       {"pusher.depth_mm=0", "pusher.depth_mm=-3", "pusher.force_max_N=0", "pusher.ramp_s=0",
        "pusher.hold_s=-1", "pusher.rest_s=0", "pusher.repeats=0", "truth.pusher.stiffness_N_per_mm=0",
        "truth.pusher.damping_Ns_per_m=-1", "truth.pusher.tremor_N=-0.1", "truth.force.drift_N_per_push=-1",
        "rig.contact.softest_N_per_mm=-1", "rig.force.tare_time_s=-0.1"})
    EXPECT_THAT(said_of({set}), HasSubstr("; expected a ")) << set;
  EXPECT_THAT(said_of({"pusher.depth_mm=nan"}), HasSubstr("expected a")) << "nan";
}

TEST(PusherInput, KeysAndNames) {
  EXPECT_THAT(said_of({"pusher.depht_mm=3"}), HasSubstr("depth_mm"));
  EXPECT_THAT(said_of({"pusher.depth=3"}), HasSubstr("depth_mm"));
  EXPECT_THAT(said_of({"pusher.object=wal"}), AllOf(HasSubstr("there is no object"), HasSubstr("wall")));
}

TEST(PusherInput, WhatTheMachineCannotDo) {
  EXPECT_THAT(said_of({"pusher.depth_mm=23.5"}),
              HasSubstr("deeper than the deflection limit of object 'wall'"));
  EXPECT_THAT(said_of({"object.wall.position_mm=[0,0,-12]"}), HasSubstr("does not reach"));
  EXPECT_THAT(said_of({"pusher.rest_s=0.1"}), HasSubstr("'rest_s' is 0.1; expected at least"));
}

// The fake's own world pushes a fake rig; a person pushes a real machine.
TEST(PusherInput, WhoPushesARealSensorIsSaid) {
  const auto notes = [](const char* rig) { return models::load(scene_file("stiffness"), rig).notes; };
  EXPECT_THAT(notes("sim"), ::testing::IsEmpty());
  EXPECT_THAT(notes("fakes"), ::testing::ElementsAre(HasSubstr("force sensor is 'netft', which feels what")));
}

TEST(PusherInput, SofterThanTheLoopRendersIsRefusedUnlessWanted) {
  const std::string soft = "behaviour.spring.stiffness_N_per_mm=0.02";
  EXPECT_THAT(said_of({soft}), HasSubstr("softer than the loop renders"));
  EXPECT_EQ(said_of({soft, "rig.contact.softest_N_per_mm=0"}), "");
  EXPECT_EQ(said_of({soft, "rig.contact.softest_N_per_mm=0.02"}), "");
  EXPECT_THAT(said_of({soft, "rig.contact.softest_N_per_mm=0.021"}), HasSubstr("softer"));
}

// ---- [user.reaches].

std::string said_reaching(const std::vector<std::string>& set, const std::string& scene = "reaching") {
  return error_of([&] { (void)trial::prepare_setup(models::load(scene_file(scene), "", set)); });
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

// ---- Bad [user.session] tables: one line each, with the mistake and the remedy.

std::string said_session(const std::vector<std::string>& set, const std::string& scene = "session") {
  return error_of([&] { (void)trial::prepare_setup(models::load(scene_file(scene), "sim", set)); });
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
  // Any object counts, because the machine follows a tool to the nearest one. So does the second tool's place
  // beside it.
  EXPECT_THAT(said_session({"user.session.tray_mm=[-150,0,60]"}, "training"),
              AllOf(HasSubstr("'tray_mm' is 68 mm from the surface of 'bone'"), HasSubstr("pause_mm")));
  EXPECT_THAT(said_session({"user.session.tray_mm=[0,-150,0]"}), HasSubstr("the other tool's place"));
  EXPECT_THAT(said_session({"user.push_N=3"}), HasSubstr("expected no 'push_N'"));
  EXPECT_THAT(said_session({"user.session.polar_max_dge=3"}), HasSubstr("polar_max_deg"));
}

// ---- Bad keys of the scene `synchrony` and of its rig and ground truth: one line each, with its place.

std::string said_synchrony(const std::vector<std::string>& set) {
  try {
    (void)trial::prepare_setup(models::load(scene_file("synchrony"), "sim", set));
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
    return e.what();
  }
  return {};
}

TEST(SynchronyInput, TheShippedSceneIsReady) { EXPECT_EQ(said_synchrony({}), ""); }

TEST(SynchronyInput, LimitsOfContacts) {
  const std::string key = "object.ball.limits_mm=";
  EXPECT_THAT(said_synchrony({key + "[]"}), AllOf(HasSubstr("is empty"), HasSubstr("expected")));
  EXPECT_THAT(said_synchrony({key + "[6, 0, 2]"}),
              AllOf(HasSubstr("'limits_mm[1]' is 0"), HasSubstr("expected")));
  EXPECT_THAT(said_synchrony({key + "[6, -4]"}), HasSubstr("'limits_mm[1]' is -4"));
  EXPECT_THAT(said_synchrony({key + "[6, nan]"}), HasSubstr("expected"));
  EXPECT_THAT(said_synchrony({key + "6"}), HasSubstr("expected"));
  EXPECT_THAT(
      said_synchrony({key + "[6, 7]"}),
      AllOf(HasSubstr("'limits_mm[1]' is 7"), HasSubstr("expected at most 6 mm"), HasSubstr("lower it")));
  EXPECT_THAT(said_synchrony({key + "[6, 0.3]"}), HasSubstr("waits deeper than the deflection limit"));
  std::string many = "[2";
  for (int i = 0; i < 16; ++i) many += ", 2";
  EXPECT_THAT(said_synchrony({key + many + "]"}),
              AllOf(HasSubstr("has 17 elements"), HasSubstr("at most 16")));
  EXPECT_THAT(said_synchrony({"object.ball.limit_mm=6"}), HasSubstr("both 'limit_mm' and 'limits_mm'"));
  EXPECT_EQ(said_synchrony({key + "unset", "object.ball.limit_mm=6"}), "");
}

TEST(SynchronyInput, DepthsOfPresses) {
  EXPECT_THAT(said_synchrony({"user.depths_mm=[]"}), HasSubstr("is empty"));
  EXPECT_THAT(said_synchrony({"user.depths_mm=[6, 0]"}), HasSubstr("'depths_mm[1]' is 0"));
  EXPECT_EQ(said_synchrony({"user.depths_mm=unset"}), "");
}

TEST(SynchronyInput, DisplayAndWhatGives) {
  EXPECT_THAT(said_synchrony({"rig.display.tip=fusd"}), AllOf(HasSubstr("fusd"), HasSubstr("fused")));
  for (const char* set :
       {"rig.display.lead_ms=-1", "rig.display.lead_ms=201", "rig.display.compliance_um_per_N=-1",
        "truth.contact.compliance_um_per_N=-1", "truth.contact.flexure_um_per_N=-1", "truth.hand.tilt_deg=46",
        "truth.hand.tilt_rate_hz=-1", "truth.tracker.turn_noise_deg=-1", "truth.display.rate_hz=0"})
    EXPECT_THAT(said_synchrony({set}), HasSubstr("; expected a ")) << set;
}

TEST(SynchronyInput, ALimitOfTheRealBallIsRefused) {
  EXPECT_THAT(
      error_of([&] { (void)models::load(scene_file("rig_A"), "sim", {"object.ball.limits_mm=[6]"}); }),
      AllOf(HasSubstr("is real"), HasSubstr("limits_mm")));
}

// ---- Tools of impossible masses: refused by name before anything moves.

// The error message of a whole trial, which builds the twin.
std::string said_tool(const std::string& scene, const std::string& rig, const std::vector<std::string>& set) {
  try {
    trial::TrialOptions options;
    options.seconds = 0.5;
    const trial::TrialResult result = trial::Trial(models::load(scene_file(scene), rig, set), options).run();
    return result.divergence;
  } catch (const Error& e) {
    return e.what();
  }
}

// A file may state at least a milligram; the twin refuses a mass that the simulated hand cannot hold.
TEST(ToolInput, AMassThatIsNoneIsRefused) {
  for (const char* mass : {"0", "-1", "1e-20", "1e-9", "9e-7", "nan", "inf"}) {
    EXPECT_THAT(said_tool("wall", "vishap", {std::string("tool.finger.mass_kg=") + mass}),
                AllOf(HasSubstr("'mass_kg'"), HasSubstr("expected"), Not(HasSubstr("\n"))))
        << mass;
    EXPECT_THAT(said_tool("session", "sim", {std::string("tool.probe.mass_kg=") + mass}),
                HasSubstr("'mass_kg'"))
        << mass;
  }
}

TEST(ToolInput, AToolThatTheHandCannotHoldIsRefusedByName) {
  for (const char* mass : {"1e-6", "1e-3", "0.00217"}) {
    EXPECT_THAT(
        said_tool("wall", "vishap", {std::string("tool.finger.mass_kg=") + mass}),
        AllOf(HasSubstr("tool 'finger' weighs"), HasSubstr("expected more than"), Not(HasSubstr("\n"))))
        << mass;
    EXPECT_THAT(said_tool("session", "sim", {std::string("tool.probe.mass_kg=") + mass}),
                HasSubstr("tool 'probe' weighs"))
        << mass;
  }
}

// A tracker cannot measure the rotation of a tool about the line through its markers. With 0.3 mm noise the
// first of these tools errs by almost any angle, the second by 3 deg (rms).
TEST(ToolInput, MarkersThatAreAlmostOnALineAreRefused) {
  const auto said = [](const std::string& markers) {
    return said_tool("tennis_ball", "sim", {"tool.stylus.markers_mm=" + markers});
  };
  EXPECT_THAT(
      said("[[0, 0, 0], [60, 0, 0], [130, 0.031, 0]]"),
      AllOf(HasSubstr("the markers of tool 'stylus' are on a line, or almost: they are 0.01 mm rms off "
                      "it; expected at least 3.46 mm, or"),
            HasSubstr("move one of 'markers_mm'"), Not(HasSubstr("\n"))));
  EXPECT_THAT(said("[[0, 0, 0], [60, 7, 0], [130, 0, 0]]"), HasSubstr("are on a line, or almost: they are"));
  EXPECT_EQ(said("[[0, 0, 0], [60, 8, 0], [130, 0, 0]]"), "");
  // Each of more markers may be nearer to the line, and off it in any direction.
  EXPECT_THAT(said("[[0, 0, 0], [20, 4, 0], [60, 0, 3], [130, 0, 0]]"), HasSubstr("at least 3.00 mm, or"));
  EXPECT_EQ(said("[[0, 0, 0], [20, 6, 0], [60, 0, 6], [130, 0, 0]]"), "");
  EXPECT_THAT(said("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]"), HasSubstr("they are 0.00 mm rms off"));
}

// 2 b h + k h^2 = 8.7 g at 1 ms: a quarter of that is where the grip diverges. A shorter step holds less.
TEST(ToolInput, WhatIsNotRefusedRuns) {
  EXPECT_EQ(said_tool("wall", "vishap", {"tool.finger.mass_kg=0.0022"}), "");
  EXPECT_EQ(said_tool("tennis_ball", "sim", {"tool.stylus.mass_kg=0.0022"}), "");
  EXPECT_EQ(said_tool("tennis_ball", "sim", {"tool.stylus.mass_kg=0.0011", "truth.world.timestep_us=500"}),
            "");
}

}  // namespace
}  // namespace enc::test
