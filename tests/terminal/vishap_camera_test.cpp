// The fakes of the VisHap laboratory on the wall clock: pictures of the fake cameras drive vision, and vision
// drives the arm behind the fake libHD.so. A busy machine draws fewer pictures than the cameras expose, which
// delays a touch but keeps the verdict; a machine that stalls for longer is asked again.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/vishap_fakes.h"

namespace enc::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

// One press, slow enough for a few pictures a second.
const Words kPress{"user.approach_mm_s=[100]", "user.press_s=1", "user.hold_s=0.5", "user.release_s=1",
                   "user.rest_s=0.5"};
const Words kArmed{"--armed", "--yes", "--for-s", "7"};

double contact_time(const nlohmann::json& run) { return run["modes_s"].value("contact", 0.0); }

// Why a run says nothing of the devices, or "": no pictures for as long as tracker.lost_age_ms (600), or an
// arm whose thread was kept waiting.
std::string stalled(const nlohmann::json& run) {
  const nlohmann::json vision = run.value("vision", nlohmann::json::object());
  double most = 0.0;
  for (const char* part : {"interval_ms", "age_ms"}) {
    const nlohmann::json value = vision.value(part, nlohmann::json::object()).value("max", nlohmann::json());
    if (!value.is_number()) return "no pictures";
    most += value.get<double>();
  }
  if (most >= 600) return "pictures up to " + std::to_string(most) + " ms old";
  const bool late = run.value("log", nlohmann::json::array()).dump().find("its own thread came too late") !=
                    std::string::npos;
  return late ? "the arm's thread came too late" : "";
}

// Beside the hand tracker alone the twin has arm, camera and hand in one world, and presses as in the pure
// simulation.
TEST(VisHapLaboratory, RunsOverAllDevicesAndOverTheHandTrackerEndAsTheTwins) {
  const VisHapFakes there(false, kPress);
  const nlohmann::json pure = there.result({"arm", "camera", "hand_tracker"}, {}),
                       real = there.result({}, kArmed, stalled),
                       hand = there.result({"arm", "camera"}, {"--for-s", "7"}, stalled);
  EXPECT_EQ(pure["contacts"], 1);
  for (const nlohmann::json& run : {real, hand}) {
    SCOPED_TRACE(run.dump());
    EXPECT_EQ(run["contacts"], 1);
    EXPECT_NEAR(contact_time(run) / contact_time(pure), 1.0, 0.3);
    EXPECT_EQ(run["holds"].size(), 0U);
  }
  EXPECT_THAT(hand["log"].dump(), ContainsRegex("answered: [1-9][0-9]* hands, "));
  for (const char* device : {"arm", "hand_tracker"})
    EXPECT_THAT(real["devices"].value(device, ""), HasSubstr("(a fake)"));
  EXPECT_THAT(real["devices"].value("tracker", ""), HasSubstr("paired camera @encounter_"));
}

// The camera and the arm beside the twin. The camera, the arm and the twin's hand then belong to two worlds:
// a hand that sees no arm, or an arm that meets no hand, presses nothing, so that its release may be a second
// touch.
TEST(VisHapLaboratory, CameraOrArmAlone) {
  const VisHapFakes there(false, kPress);
  const nlohmann::json camera = there.result({"arm", "hand_tracker"}, {"--for-s", "5"}, stalled),
                       arm = there.result({"camera", "hand_tracker"}, kArmed, stalled);
  for (const nlohmann::json& run : {camera, arm}) EXPECT_GE(run["contacts"], 1) << run;
  EXPECT_THAT(arm["devices"].value("arm", ""), HasSubstr("(a fake)"));
  EXPECT_TRUE(arm["vision"]["threaded"]);
  EXPECT_THAT(there.run({"camera", "hand_tracker"}, {"--armed", "--lockstep"}).err,
              HasSubstr("its time goes on by itself; leave out --lockstep"));
}

}  // namespace
}  // namespace enc::test
