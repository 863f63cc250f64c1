// The travel programme, driven by hand: a machine that is where it was told to be.
#include "core/control/task/carry/travel.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

SceneSpec travel_scene() {
  SceneSpec spec = test::ball_scene();
  spec.objects.clear();
  spec.behaviours.clear();
  spec.force.reset();
  spec.gripper.emplace();
  TravelSpec& travel = spec.travel.emplace();
  travel.axes = "x";
  travel.stops = {0.0, 0.010, 0.040};
  travel.dwell = 0.2;
  travel.speed = 0.040;
  return spec;
}
Scene made(const SceneSpec& spec) { return prepare(spec, RigSpec{}); }

// A loop whose gripper holds its tool from `tick` on.
Loop with_grip(const SceneSpec& spec, int from = 0) {
  Loop loop(made(spec));
  loop.spoil = [from, ticks = 0](Inputs& in) mutable {
    in.grip = {{GripPhase::closing, 0.010, 0.0, false}, in.tip.t, Health::ok};
    if (ticks++ >= from) in.grip.value = {GripPhase::closed, 0.006, 100.0, true};
  };
  return loop;
}
int until(Loop& loop, TravelPhase phase, std::int32_t leg) {
  int ticks = 0;
  while ((recall<Travelling>(loop.state).phase != phase || recall<Travelling>(loop.state).leg != leg) &&
         ticks < 60'000) {
    loop.tick();
    ++ticks;
  }
  return ticks;
}
std::string refusal(const SceneSpec& spec) {
  try {
    made(spec);
  } catch (const Error& e) {
    return e.key();
  }
  return "nothing";
}

TEST(Travel, LegsOfEachAxisAndWay) {
  SceneSpec spec = travel_scene();
  spec.travel->axes = "xz";
  spec.travel->ways = TravelWays::both_ways;
  spec.travel->repeats = 2;
  const Travel travel = *made(spec).travel();
  ASSERT_EQ(travel.legs.size(), 2U * 2U * 5U);
  EXPECT_EQ(travel.legs[0].axis, -1);  // x begins where the machine is
  EXPECT_EQ(travel.legs[0].length, 0.0);
  EXPECT_EQ(travel.legs[1].way, 1);
  EXPECT_EQ(travel.legs[2].axis, 0);
  EXPECT_LT((travel.legs[2].to - Point<'W'>(0.040, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(travel.legs[3].way, -1);
  EXPECT_LT((travel.legs[5].to - Point<'W'>(0, 0, -0.020)).norm(), 1e-15);
  EXPECT_EQ(travel.legs[6].axis, 2);
  EXPECT_LT((travel.legs[7].to - Point<'W'>(0, 0, 0.020)).norm(), 1e-15);
}

TEST(Travel, WaitsForTheJawsThenMovesInTrapezoids) {
  Loop loop = with_grip(travel_scene(), 300);
  loop.tick(300);
  EXPECT_EQ(loop.out.mode, Mode::travel);
  EXPECT_EQ(recall<Travelling>(loop.state).phase, TravelPhase::wait);
  EXPECT_LT(loop.tip().e().norm(), 1e-12);
  until(loop, TravelPhase::move, 2);  // 10 to 40 mm
  const double top = 0.040;
  const double a = loop.scene.reach.acceleration;
  // Half a ramp, where it has its whole acceleration; then even; 30 mm in 30 / 40 + 40 / 410 s.
  loop.tick(49);
  EXPECT_NEAR(recall<Commanded>(loop.state).command_velocity.norm(), a * 0.050, 1e-9);
  loop.tick(200);
  EXPECT_NEAR(recall<Commanded>(loop.state).command_velocity.norm(), top, 1e-9);
  const int rest = until(loop, TravelPhase::dwell, 2);
  EXPECT_NEAR((250 + rest) * 1e-3, 0.030 / top + top / a, 0.015);
  EXPECT_NEAR(loop.tip().xyz[0], 0.040, 1.1e-6);
  EXPECT_LT(std::abs(loop.tip().xyz[1]) + std::abs(loop.tip().xyz[2]), 1e-12);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
}

TEST(Travel, EndsInItsTimeAndStandsStill) {
  SceneSpec spec = travel_scene();
  spec.travel->axes = "xyz";
  spec.travel->ways = TravelWays::both_ways;
  Loop loop = with_grip(spec);
  const double longest = loop.scene.travel()->duration();
  const int ticks = until(loop, TravelPhase::done, 14);
  EXPECT_LT(ticks * 1e-3, longest);
  EXPECT_GT(ticks * 1e-3, longest - 2.6);
  const Point<'W'> there = loop.tip();
  loop.tick(500);
  EXPECT_EQ((loop.tip() - there).norm(), 0.0);
  EXPECT_TRUE(loop.always_reachable);
}

TEST(Travel, TimeStandsStillInAHold) {
  Loop loop = with_grip(travel_scene());
  until(loop, TravelPhase::dwell, 1);
  const double elapsed = recall<Travelling>(loop.state).elapsed;
  const auto hold = loop.spoil;
  loop.spoil = [&](Inputs& in) { in.grip = {{GripPhase::closed, 0.0, 0.0, false}, in.tip.t, Health::ok}; };
  loop.tick(500);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NE(loop.out.why & kToolNotHeld, 0U);
  EXPECT_EQ(recall<Travelling>(loop.state).elapsed, elapsed);
  loop.spoil = hold;
  EXPECT_NEAR(until(loop, TravelPhase::move, 2), 200, 3);
}

TEST(Travel, RefusesWhatTheMachineCannotDo) {
  EXPECT_EQ(refusal(travel_scene()), "nothing");
  const auto changed = [](const auto& change) {
    SceneSpec spec = travel_scene();
    change(spec);
    return refusal(spec);
  };
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->axes = "xw"; }), "travel.axes");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->axes = ""; }), "travel.axes");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0, 0.02, 0.01}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->stops = {0.0, 0.090}; }), "travel.stops");
  EXPECT_EQ(changed([](SceneSpec& s) { s.travel->speed = 0.060; }), "travel.speed");
  EXPECT_EQ(changed([](SceneSpec& s) {
              s.travel->axes = "z";
              s.travel->start = Vec3::Zero();
            }),
            "travel.stops");  // 40 mm above the zero
  EXPECT_EQ(changed([](SceneSpec& s) { s.gripper.reset(); }), "travel");
  EXPECT_EQ(changed([](SceneSpec& s) { s.user.emplace(); }), "travel");
  EXPECT_EQ(changed([](SceneSpec& s) { s.display.emplace(); }), "display");
}

}  // namespace
}  // namespace enc
