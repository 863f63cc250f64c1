// Measures of a reach, computed by hand: a prop that comes along x to a finger that comes down z. Also the
// ideal predictor: its result for a straight path, and what an arm can achieve with it.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "benchmarks/reaching/ideal.h"
#include "benchmarks/reaching/reach_runs.h"

namespace enc::bench::reaching {
namespace {

using bench::reaching::ReachMeasure;
using bench::reaching::ReachOutcome;

Scene flat_wall() {
  Scene scene;
  scene.dt = 0.001;
  scene.objects.push_back({Surface{Plane{}}, Pose<'W', 'O'>::shift(0, 0, 0), {}});
  return scene;
}

// A finger of 8 mm radius goes down with 100 mm/s from 20 mm above the wall at x = 0. The prop comes along x
// with 200 mm/s and stops at x = `stop`; the core prepares it 10 ms after the reach began. `rendered` gives
// the object that the core renders at each ms, if any.
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

// The felt object is the first one rendered while the finger touches the prop, whatever the core rendered
// before or after.
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
  const trial::PropTarget under = trial::wanted_at(wall, {0.01, 0.02, 0.03});
  EXPECT_LT((under.point - Point<'W'>(0.01, 0.02, 0.0)).norm(), 1e-15);
  EXPECT_NEAR(under.distance, 0.03, 1e-15);
  Object key{Surface{Button{0.015, 0.015, 0.01}}, Pose<'W', 'O'>::shift(0.1, 0, 0), {}};
  key.interaction.kind = Interaction::click;
  EXPECT_LT((trial::wanted_at(key, {0.104, 0.002, 0.01}).point - Point<'W'>(0.1, 0, 0)).norm(), 1e-15);
}

// A first movement of 180 mm, visible until 75 ms before the touch: one picture every 50 ms, each 50 ms late.
SeenReach seen_reach() {
  SeenReach reach;
  const Vec3 from(-0.06, 0.02, 0.17), to(0.0, 0.0, -0.01);
  const double begins = 0.1, takes = 0.6;
  const auto share = [&](double t) {
    const double s = std::clamp((t - begins) / takes, 0.0, 1.0);
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
  };
  const auto at = [&](double t) { return Vec3(from + share(t) * (to - from)); };
  double met = begins;
  while (at(met).z() > 0.0) met += 1e-4;
  reach.met = met;
  reach.where = at(met).head<2>();
  for (double t = met - 0.075 - 6 * 0.05; t < met - 0.05; t += 0.05)
    reach.pictures.push_back({at(t), t, t + 0.05});
  return reach;
}

TEST(ReachIdeal, FindsWhereAReachTouchesThatIsToldWhen) {
  const SeenReach reach = seen_reach();
  const IdealPrediction ideal = ideal_place({}, reach, reach.met, reach.met);
  EXPECT_LT((ideal.place - reach.where).norm(), 4e-3);  // the newest picture is 75 ms old
  EXPECT_GT(ideal.within, 0.1);
  EXPECT_LT(ideal.within, 1.0);
}

TEST(ReachIdeal, AnArmIsSomewhereBetweenThePlacesOfTwoPictures) {
  const SeenReach reach = seen_reach();
  const Eigen::Vector2d best = ideal_place({}, reach, reach.met, reach.met).place;
  const Eigen::Vector2d anywhere = ideal_carried({}, reach, 1e6), still = ideal_carried({}, reach, 1e-9);
  const double fourth = reach.pictures[reach.pictures.size() - 4].told;
  EXPECT_LT((anywhere - best).norm(), 1e-9);
  EXPECT_LT((still - ideal_place({}, reach, fourth, reach.met).place).norm(), 1e-9);
  EXPECT_GT((still - best).norm(), 1e-6);
  // A picture that comes too late: a prediction at the touch moves nothing.
  SeenReach late = reach;
  late.pictures.back().told = reach.met;
  const Eigen::Vector2d before = ideal_place({}, reach, reach.pictures.back().told - 1e-3, reach.met).place;
  EXPECT_LT((ideal_carried({}, late, 1e6) - before).norm(), 1e-9);
}

// The predictions do not contain the time of the touch; with unlimited acceleration the prop is at the mean
// of the predictions still to come.
TEST(ReachIdeal, AnArmFollowsWhatIsStillToCome) {
  const SeenReach reach = seen_reach();
  const std::vector<IdealCourse> courses = ideal_courses({}, reach);
  ASSERT_EQ(courses.size(), 4U);
  const double soon = 0.01;
  const Eigen::Vector2d goal = courses.back().mean(reach.met, soon);
  EXPECT_LT((ideal_followed(courses, reach.met, 1e5, soon) - goal).norm(), 0.2e-3);
  EXPECT_LT((goal - reach.where).norm(), 5e-3);
  const Eigen::Vector2d first = courses.front().mean(courses.front().told, soon);
  EXPECT_LT((ideal_followed(courses, reach.met, 1e-9, soon) - first).norm(), 1e-6);
  // The course predicts the place of the touch for that time.
  const double then = courses.back().told + 2 * IdealCourse::kEach;
  EXPECT_LT((courses.back().then[2].place - ideal_place({}, reach, courses.back().told, then).place).norm(),
            1e-12);
}

}  // namespace
}  // namespace enc::bench::reaching
