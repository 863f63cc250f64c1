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

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

// One press, slow enough for a few pictures a second.
const Words kPress{"user.approach_mm_s=[100]", "user.press_s=1", "user.hold_s=0.5", "user.release_s=1",
                   "user.rest_s=0.5"};
const Words kArmed{"--armed", "--yes", "--for-s", "7"};

double contact_time(const nlohmann::json& run) { return run["modes_s"].value("contact", 0.0); }

// Whether the machine kept up: pictures came often enough for tracker.lost_age_ms (600), the background was
// learned before the finger came, and the arm's thread was not kept waiting.
bool in_time(const nlohmann::json& run) {
  const nlohmann::json &between = run["vision"]["interval_ms"]["max"], &age = run["vision"]["age_ms"]["max"];
  const std::string log = run["log"].dump();
  return between.is_number() && age.is_number() && between.get<double>() + age.get<double>() < 600 &&
         log.find("a finger stood in the frames") == std::string::npos &&
         log.find("its own thread came too late") == std::string::npos;
}

// A machine that stalls has not answered the question: it is asked again, three times in all.
nlohmann::json asked(const VisHapFakes& there, const std::vector<std::string>& simulated, Words more) {
  more.emplace_back("--json");
  for (int i = 1;; ++i) {
    const tests::Result result = there.run(simulated, more);
    nlohmann::json run = nlohmann::json::parse(result.out, nullptr, false);
    if (i < 3 && run.is_object() && !in_time(run)) continue;
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    return run;
  }
}

// Beside the hand tracker alone the twin has arm, camera and hand in one world, and presses as in the pure
// simulation.
TEST(VisHapLaboratory, RunsOverAllDevicesAndOverTheHandTrackerEndAsTheTwins) {
  const VisHapFakes there(false, kPress);
  const nlohmann::json pure = there.result({"arm", "camera", "hand_tracker"}, {}),
                       real = asked(there, {}, kArmed),
                       hand = asked(there, {"arm", "camera"}, {"--for-s", "7"});
  EXPECT_EQ(pure["contacts"], 1);
  for (const nlohmann::json& run : {real, hand}) {
    SCOPED_TRACE(run["vision"].dump() + run["modes_s"].dump() + run["holds"].dump());
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
  const nlohmann::json camera = asked(there, {"arm", "hand_tracker"}, {"--for-s", "5"}),
                       arm = asked(there, {"camera", "hand_tracker"}, kArmed);
  for (const nlohmann::json& run : {camera, arm})
    EXPECT_GE(run["contacts"], 1) << run["modes_s"] << run["vision"] << run["log"];
  EXPECT_THAT(arm["devices"].value("arm", ""), HasSubstr("(a fake)"));
  EXPECT_TRUE(arm["vision"]["threaded"]);
  EXPECT_THAT(there.run({"camera", "hand_tracker"}, {"--armed", "--lockstep"}).err,
              HasSubstr("its time goes on by itself; leave out --lockstep"));
}

}  // namespace
}  // namespace enc::test
