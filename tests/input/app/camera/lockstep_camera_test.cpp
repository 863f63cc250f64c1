// The fakes of the VisHap laboratory in lockstep: vision sees pictures of the fake cameras, and moves the arm
// behind the fake libHD.so, in virtual time.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/vishap_fakes.h"

namespace enc::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

const Words kAll{"arm", "camera", "hand_tracker"};
// The beginning of a fast press.
const Words kPress{"user.approach_mm_s=[200]", "truth.camera.hand_from_s=0.6"};
const Words kPure{"--for-s", "2.5"}, kLockstep{"--for-s", "2.5", "--armed", "--lockstep"};

// The pictures of RGB3 are those of the twin, and the arm's numbers cross the fake library as they are.
TEST(VisHapLockstep, ARunThroughAllDevicesEqualsTheTwinsToTheBit) {
  const VisHapFakes there(true, kPress);
  const nlohmann::json pure = there.result(kAll, kPure), first = there.result({}, kLockstep),
                       again = there.result({}, kLockstep);
  EXPECT_EQ(pure["contacts"], 1);
  EXPECT_EQ(first["state_hash"], pure["state_hash"]);
  EXPECT_EQ(again["state_hash"], pure["state_hash"]);
  EXPECT_THAT(first["log"].dump(), HasSubstr("0.000 ms apart on average, 0.000 ms at most"))
      << "a stamp of 0";
  // The world of the run has its own hand, which feels nothing of the fake's arm, so only the touch is the
  // same.
  const nlohmann::json arm = there.result({"camera", "hand_tracker"}, kLockstep);
  EXPECT_EQ(arm["contacts"], 1);
  EXPECT_NEAR(arm["modes_s"].value("away", 0.0), pure["modes_s"].value("away", 0.0), 0.001);
}

TEST(VisHapLockstepLong, OtherSeedsAreEqualToTheBit) {
  for (const int seed : {2, 3, 4, 5}) {
    const VisHapFakes there(true, kPress, VisHapFakes::kScene, seed);
    const nlohmann::json pure = there.result(kAll, kPure), fakes = there.result({}, kLockstep);
    EXPECT_GE(pure["contacts"], 1) << seed;
    EXPECT_EQ(fakes["state_hash"], pure["state_hash"]) << seed;
  }
}

TEST(VisHapLockstep, WhatDoesNotFitIsOneLine) {
  const auto refused = [](const Words& words, int code, const std::string& why) {
    const tests::Result result = tests::run_program(words);
    EXPECT_EQ(result.code, code) << result.out;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(why));
  };
  const std::string wall = tests::shipped_scene("wall"), ball = tests::shipped_scene("tennis_ball");
  const Words alone{"--set", "rig.driver.v4l2.left=@nobody_l", "--set", "rig.driver.v4l2.right=@nobody_r"};
  Words words{"run", VisHapFakes::kScene, "--rig", "fakes_vishap", "--armed", "--yes"};
  words.insert(words.end(), alone.begin(), alone.end());
  refused(words, 3, "no fake camera listens there; expected one; start `encounter fake RIG` first");
  refused({"fake", "fakes_vishap", "--scene", ball}, 2, "[manipulator]");
  // Of a scene without a camera the fakes have none, whichever scene the run has.
  const VisHapFakes there(true, {}, wall);
  const tests::Result run = there.run({}, kLockstep);
  EXPECT_EQ(run.code, 3) << run.out;
  EXPECT_THAT(run.err, HasSubstr("no fake camera listens there"));
  EXPECT_THAT(there.run({"camera", "hand_tracker"}, {}).err, HasSubstr("begin the fake without --lockstep"));
}

TEST(VisHapLockstep, AHandTrackerWithItsOwnTimeIsRefused) {
  const VisHapFakes there(true, kPress);
  Words words = kLockstep;
  words.insert(words.end(), {"--set", "rig.hand_tracker.driver=leap"});
  EXPECT_THAT(there.run({"hand_tracker"}, words).err,
              HasSubstr("module 'leap' cannot keep step with a fake"));
}

}  // namespace
}  // namespace enc::test
