// Bad [pusher] tables: one line each, and what is softer than the loop renders is refused unless it is
// wanted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// What the scene `stiffness` says with these settings; empty if it can be made ready.
std::string said_of(const std::vector<std::string>& set, const std::string& scene = "stiffness") {
  try {
    (void)trial::prepare_setup(models::load(scene_file(scene), "sim", set));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
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

// A fake of the rig is pushed by its own world, a machine by whoever is there.
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

}  // namespace
}  // namespace enc::test
