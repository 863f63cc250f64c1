// Whole runs of presses: within all limits on every tick, and the force at the limit is the object's.
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/trial/runs.h"
#include "trial/measure/press_measure.h"

namespace enc {
namespace {

using test::force_at_limit;
using test::kDeep;
using test::look;
using test::quick;
using test::run;
using test::scene;
using test::Seen;
using test::Set;

TEST(TrialPress, SpeedAndAccelerationStayWithinTheLimitsOnEveryTickOfTheBall) {
  const Seen seen = look(scene("tennis_ball"));
  EXPECT_GT(seen.onlooker.ticks, 60'000);
  EXPECT_EQ(seen.result.contacts, 5);
  seen.onlooker.expect_within_limits();
  EXPECT_GT(seen.onlooker.fastest, 0.02);  // it did move
  EXPECT_GT(seen.onlooker.hardest, 0.3);
  EXPECT_LE(seen.onlooker.outside, 0.0);
  EXPECT_TRUE(seen.result.holds.empty());
}

TEST(TrialPress, TwelveNewtonAtTheLimitFromEveryPolarAngle) {
  for (const char* polar : {"0", "12.5", "25", "37.5", "50"}) {
    Set set = kDeep;
    set.push_back(std::string("user.polar_deg=") + polar);
    std::int32_t contacts = 0;
    double deepest = 0.0;
    const double force = force_at_limit(scene("tennis_ball", set), contacts, deepest);
    EXPECT_EQ(contacts, 1) << polar;
    EXPECT_NEAR(force, 12.0, 1.0) << polar;
    EXPECT_LE(deepest, 6.05e-3) << polar;
  }
}

// The machine begins where it stands: its tip may be outside of the object until it has got there.
TEST(TrialPress, AnObjectThatStandsAsideIsEnteredWithoutAHold) {
  for (const char* set : {"object.ball.position_mm=[20,0,-20]", "object.ball.position_mm=[-15,15,-20]"}) {
    const trial::TrialResult result = run(scene("tennis_ball", quick({set})));
    EXPECT_TRUE(result.holds.empty()) << set;
    EXPECT_EQ(result.contacts, 1) << set;
  }
}

TEST(TrialPress, TheLimitIsHeldUnderThirtyNewton) {
  for (const int limit : {6, 4, 2}) {
    std::int32_t contacts = 0;
    double deepest = 0.0;
    double strongest = 0.0;
    const models::Setup setup =
        scene("push_limit", {"user.push_N=30", "object.ball.limit_mm=" + std::to_string(limit)});
    trial::PressMeasure measure(setup);
    trial::TrialOptions options;
    options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
    contacts = run(setup, options).contacts;
    deepest = measure.presses().front().peak_deflection;
    strongest = measure.presses().front().peak_force;
    EXPECT_EQ(contacts, 1) << limit;
    EXPECT_LE(deepest, limit * 1e-3 + 0.05e-3);
    EXPECT_GE(deepest, limit * 1e-3 - 0.05e-3) << "the push did not reach the limit";
    EXPECT_GT(strongest, 25.0) << "there was no such push";
  }
}

}  // namespace
}  // namespace enc
