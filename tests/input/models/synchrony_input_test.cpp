// Bad keys of the scene `synchrony` and of what it uses of rig and truth: one line each, with its place.
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
  try {
    (void)models::load(scene_file("rig_A"), "sim", {"object.ball.limits_mm=[6]"});
    FAIL() << "was accepted";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("is real"), HasSubstr("limits_mm")));
  }
}

}  // namespace
}  // namespace enc::test
