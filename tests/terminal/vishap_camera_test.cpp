// The fakes of the VisHap laboratory on the wall clock: pictures of the fake cameras drive vision, and vision
// drives the arm behind the fake libHD.so. A busy machine draws fewer pictures than the cameras expose, which
// delays a touch but keeps the verdict.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/vishap_fakes.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

// One press, slow enough for a few pictures a second.
const Words kPress{"user.approach_mm_s=[100]", "user.press_s=1", "user.hold_s=0.5", "user.release_s=1",
                   "user.rest_s=0.5"};
const Words kArmed{"--armed", "--yes", "--for-s", "7"};

double contact_time(const nlohmann::json& run) { return run["modes_s"].value("contact", 0.0); }

TEST(VisHapLaboratory, ARunOverAllDevicesEndsAsTheTwins) {
  const VisHapFakes there(false, kPress);
  const nlohmann::json pure = there.result({"arm", "camera", "hand_tracker"}, {}),
                       real = there.result({}, kArmed);
  EXPECT_EQ(pure["contacts"], 1);
  EXPECT_EQ(real["contacts"], 1);
  EXPECT_NEAR(contact_time(real) / contact_time(pure), 1.0, 0.3);
  for (const char* device : {"arm", "hand_tracker"})
    EXPECT_THAT(real["devices"].value(device, ""), HasSubstr("(a fake)"));
  EXPECT_THAT(real["devices"].value("tracker", ""), HasSubstr("paired camera @encounter_"));
}

// The hand that the cameras see presses no arm, so that its release may be a second touch. A simulated camera
// holds up the loop on the wall clock, and an arm is not armed beside it (for its touch in lockstep see
// tests/input/app/camera).
TEST(VisHapLaboratory, EachDeviceAlone) {
  const VisHapFakes there(false, kPress);
  EXPECT_GE(there.result({"arm", "hand_tracker"}, {"--for-s", "5"})["contacts"], 1);
  const tests::Result hand = there.run({"arm", "camera"}, {"--for-s", "1"});
  EXPECT_THAT(hand.out, ContainsRegex("\nlog .*answered: [1-9][0-9]* hands, "));
  const tests::Result arm = there.run({"camera", "hand_tracker"}, kArmed);
  EXPECT_THAT(there.run({"camera", "hand_tracker"}, {"--armed", "--lockstep"}).err,
              HasSubstr("its time goes on by itself; leave out --lockstep"));
  EXPECT_EQ(arm.code, 2);
  EXPECT_THAT(arm.err, AllOf(HasSubstr("works within the haptic loop"), HasSubstr("not armed for it")));
}

}  // namespace
}  // namespace enc::test
