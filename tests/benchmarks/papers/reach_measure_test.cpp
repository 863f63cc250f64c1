// What is said of a reach, by hand: a prop that comes along x to a finger that comes down z.
#include "benchmarks/reaching/reach_measure.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "benchmarks/reaching/reaching.h"

namespace enc::test {
namespace {

using bench::reaching::ReachMeasure;
using bench::reaching::ReachOutcome;

Scene flat_wall() {
  Scene scene;
  scene.dt = 0.001;
  scene.objects.push_back({Surface{Plane{}}, Pose<'W', 'O'>::shift(0, 0, 0), {}});
  return scene;
}

// A finger of 8 mm radius goes down with 100 mm/s from 20 mm over the wall at x = 0; the prop comes along x
// with 200 mm/s and stops at x = `stop`, 10 ms after the reach began the core prepares.
// The core renders what `rendered` says of the ms: an object, or none.
std::vector<ReachOutcome> reach(
    double stop, bool touching = true,
    const std::function<std::int32_t(int)>& rendered = [](int) { return -1; }) {
  Scene scene = flat_wall();
  scene.objects.push_back(scene.objects.front());
  ReachMeasure measure;
  Tick tick;
  sim::Truth truth;
  Inputs in;
  Outputs out;
  truth.tool_radius = 0.008;
  truth.press = truth.aim = 0;
  truth.tool_velocity = Vec<'W'>(0, 0, -0.1);
  for (int i = 0; i <= 250; ++i) {
    const double t = 0.001 * i;
    truth.t = Time(from_seconds(t));
    truth.phase = i == 0 ? sim::Phase::wait : sim::Phase::approach;
    truth.tool_tip = {0, 0, 0.028 - 0.1 * t};
    truth.tip = {std::max(stop, 0.030 - 0.2 * t), 0, 0};
    truth.touching = touching && i >= 200;
    truth.contact_force = Vec<'W'>(0, 0, truth.touching ? -2.0 : 0.0);
    out.mode = rendered(i) >= 0 ? Mode::contact : i < 10 ? Mode::away : Mode::follow;
    out.object = std::max(0, rendered(i));
    out.contacts = truth.touching ? 1 : 0;
    measure.see({scene, tick, truth, in, out});
  }
  return measure.reaches();
}

TEST(ReachMeasure, SaysSinceWhenThePropIsThere) {
  const std::vector<ReachOutcome> reaches = reach(0.0);
  ASSERT_EQ(reaches.size(), 1U);
  const ReachOutcome& r = reaches[0];
  EXPECT_NEAR(r.prepared, 0.010, 1e-9);
  EXPECT_NEAR(r.met, 0.200, 1e-9);  // 28 - 20 mm: the radius
  EXPECT_NEAR(r.lead(), 0.190, 1e-9);
  EXPECT_NEAR(r.travel(), 0.130, 1.1e-3);  // within 2 mm of x = 0 at 0.14 s
  EXPECT_NEAR(r.miss, 0.0, 1e-12);
  EXPECT_NEAR(r.speed, 0.1, 1e-12);
  EXPECT_NEAR(r.impact, 2.0, 1e-12);
  EXPECT_EQ(r.contacts, 1);
  EXPECT_EQ(r.prepares, 1);
  EXPECT_TRUE(r.touched);
  EXPECT_EQ(bench::reaching::in_time(reaches), 1.0);
}

TEST(ReachMeasure, APropThatIsBesideIsNotThere) {
  const std::vector<ReachOutcome> reaches = reach(0.003);
  ASSERT_EQ(reaches.size(), 1U);
  EXPECT_NEAR(reaches[0].miss, 0.003, 1e-12);
  EXPECT_TRUE(std::isnan(reaches[0].arrived));
  EXPECT_EQ(bench::reaching::in_time(reaches), 0.0);
}

TEST(ReachMeasure, AFingerThatPassesThePropMeetsTheSurfaceAllTheSame) {
  const std::vector<ReachOutcome> reaches = reach(0.020, false);
  ASSERT_EQ(reaches.size(), 1U);
  EXPECT_NEAR(reaches[0].met, 0.200, 1.1e-3);
  EXPECT_NEAR(reaches[0].miss, 0.020, 1e-12);
  EXPECT_FALSE(reaches[0].touched);
  EXPECT_EQ(reaches[0].contacts, 0);
}

// The first that is rendered while the finger touches the prop, whatever was rendered before or comes after.
TEST(ReachMeasure, SaysWhichObjectIsFelt) {
  const auto first = [](int i) { return i < 202 ? -1 : 0; };
  const ReachOutcome r = reach(0.0, true, first).at(0);
  EXPECT_EQ(r.felt, 0);
  EXPECT_NEAR(r.felt_after, 0.002, 1e-9);
  EXPECT_NEAR(r.felt_depth, 0.0002, 1e-9);
  const auto before = [](int i) { return i < 190 ? -1 : i < 200 ? 1 : 0; };
  EXPECT_EQ(reach(0.0, true, before).at(0).felt, 0);
  const auto after = [](int i) { return i < 202 ? -1 : i < 205 ? 0 : 1; };
  EXPECT_EQ(reach(0.0, true, after).at(0).felt, 0);
  const auto wrong = [](int i) { return i < 202 ? -1 : 1; };
  EXPECT_EQ(reach(0.0, true, wrong).at(0).felt, 1) << "and not the one that is aimed at";
  const ReachOutcome none = reach(0.0).at(0);
  EXPECT_EQ(none.felt, -1);
  EXPECT_TRUE(bench::reaching::felts({none}, &ReachOutcome::felt_after).empty());
}

TEST(WantedAt, IsUnderTheFingerOrInTheMiddleOfAButton) {
  Object wall{Surface{Plane{}}, Pose<'W', 'O'>::shift(0, 0, 0), {}};
  const trial::Wanted under = trial::wanted_at(wall, {0.01, 0.02, 0.03});
  EXPECT_LT((under.point - Point<'W'>(0.01, 0.02, 0.0)).norm(), 1e-15);
  EXPECT_NEAR(under.distance, 0.03, 1e-15);
  Object key{Surface{Button{0.015, 0.015, 0.01}}, Pose<'W', 'O'>::shift(0.1, 0, 0), {}};
  key.interaction.kind = Interaction::click;
  EXPECT_LT((trial::wanted_at(key, {0.104, 0.002, 0.01}).point - Point<'W'>(0.1, 0, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace enc::test
