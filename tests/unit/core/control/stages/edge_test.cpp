// The whole tip stays inside the object beside an edge, in a corner and in a hollow, on each tick and from
// each side. prepare() refuses an object without room for it.
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/control/safety/inside.h"
#include "core/control/scene/press_check.h"
#include "core/control/stages/guard.h"
#include "models/setup/scene_file.h"
#include "models/shapes/shapes.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"
#include "tests/unit/trial/runs.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using test::Loop, test::kToolRadius;
using testing::HasSubstr;

constexpr double kGuard = 50e-6;  // m
constexpr double kTip = 0.005;    // m
constexpr double kHigh = -0.022;  // m, middle of a cube of 60 mm: its top is 8 mm above W's origin

// The tool glides along straight lines over the object, slightly in and out of it, at 11 mm/s and at a hand's
// speed. No force: the tool alone leads the tip.
void glide(Loop& loop, double speed, int ticks, std::uint64_t seed, double reach_xy, double z_low,
           double z_high) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Vec3 at(0, 0, z_high), aim = at;
  std::int32_t holds = 0;
  for (int i = 0; i < ticks; ++i) {
    if ((aim - at).norm() < 1e-6)
      aim = Vec3((2 * unit(random) - 1) * reach_xy, (2 * unit(random) - 1) * reach_xy,
                 z_low + (z_high - z_low) * unit(random));
    const Vec3 way = aim - at;
    at += way * std::min(1.0, speed * 1e-3 / way.norm());
    loop.tool_tip = Point<'W'>(at);
    loop.tick();
    holds += loop.out.mode == Mode::hold ? 1 : 0;
    ASSERT_LE(loop.worst_outside, kGuard) << "tick " << i << ", seed " << seed;
  }
  EXPECT_GT(loop.worst_outside, -0.01) << "the tip was never inside";
  EXPECT_EQ(holds, 0) << why_text(loop.out.why);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  EXPECT_TRUE(loop.always_reachable);
}

Loop loop_of(const SceneSpec& spec) { return Loop(prepare(spec, test::exact_rig())); }

TEST(Edges, TheWholeTipStaysInsideOfACube) {
  for (const double speed : {0.011, 0.2}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      Loop loop = loop_of(test::mesh_scene(test::box(0.06, 0.06, 0.06), kHigh));
      glide(loop, speed, 20'000, seed, 0.035, -0.01, 0.02);
    }
  }
}

TEST(Edges, TheWholeTipStaysInsideOfACubeThatStandsOnItsCorner) {
  Loop loop = loop_of(
      test::mesh_scene(test::box(0.06, 0.06, 0.06), -0.040, Vec3(std::atan(std::sqrt(0.5)), M_PI / 4, 0.3)));
  glide(loop, 0.05, 20'000, 4, 0.03, -0.02, 0.02);
}

TEST(Edges, TheWholeTipStaysInsideOfAWedge) {
  // An edge of 40 degrees, upwards.
  const double half = 0.08 * std::tan(20.0 * M_PI / 180.0);
  for (const double speed : {0.011, 0.2}) {
    Loop loop =
        loop_of(test::mesh_scene(test::prism({{-half, -0.08}, {half, -0.08}, {0.0, 0.0}}, 0.06), 0.02));
    glide(loop, speed, 20'000, 5, 0.02, -0.02, 0.03);
  }
}

TEST(Edges, TheWholeTipStaysInsideOfAGroove) {
  for (const double speed : {0.011, 0.2}) {
    Loop loop = loop_of(test::mesh_scene(test::groove(), -0.01));
    glide(loop, speed, 20'000, 6, 0.03, -0.01, 0.04);
  }
}

// The straight line from wall to wall leads through the groove, so the tip waits inside.
TEST(Edges, WhereTheNearestPointLeapsAcrossAGrooveTheTipWaitsInside) {
  Loop loop = loop_of(test::mesh_scene(test::groove(), -0.01));
  loop.tool_tip = Point<'W'>(0.004, 0, 0.012);
  loop.tick(1500);
  const double right = loop.tip().xyz[0];
  EXPECT_GT(right, 0.01);
  loop.tool_tip = Point<'W'>(-0.004, 0, 0.012);
  loop.tick(3000);
  EXPECT_LE(loop.worst_outside, kGuard);
  EXPECT_NE(loop.out.mode, Mode::hold) << why_text(loop.out.why);
  EXPECT_LT(recall<CommandState>(loop.state).command_velocity.norm(), 1e-4);  // and it stands there
  loop.tool_tip = Point<'W'>(0.004, 0, 0.012);
  loop.tick(1500);
  EXPECT_NEAR(loop.tip().xyz[0], right, 1e-5);
}

TEST(Edges, TheWholeTipStaysInsideOfAHare) {
  for (const double speed : {0.011, 0.2}) {
    Loop loop = loop_of(test::mesh_scene(models::hare_mesh(), -0.018));
    glide(loop, speed, 20'000, 7, 0.03, -0.03, 0.03);
  }
}

// Near one plane the place is straight under the surface. Beside an edge it is exactly the nearest possible
// place.
TEST(Edges, ThePlaceInsideIsTheNearestOne) {
  const Scene scene = prepare(test::mesh_scene(test::box(0.06, 0.06, 0.06), kHigh), test::exact_rig());
  ObjectHint hint;
  stages::Inside inside(scene, 0, kTip, Vec<'W'>::zero(), hint);
  const double in = 0.03 - kTip;
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(-0.05, 0.05);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(unit(random), unit(random), unit(random));
    const Vec3 exact = p.cwiseMin(in).cwiseMax(-in);
    const Vec3 found = inside.nearest_to(Point<'W'>(Vec3(p + Vec3(0, 0, kHigh)))).e() - Vec3(0, 0, kHigh);
    // The nearest face of a point outside beyond an edge is not the nearest wall. The place found is still
    // inside.
    EXPECT_LE(found.cwiseAbs().maxCoeff(), in + 1e-6);
    if (p.cwiseAbs().maxCoeff() <= 0.03) {
      EXPECT_LT((found - exact).norm(), 1e-6) << p.transpose();
    }
  }
}

// A tool that glides at 11 mm/s to and fro over the top of a cube, beyond its edges.
class GlidingTool : public PoseTracker {
 public:
  explicit GlidingTool(const Scene& scene)
      : X_CW_(scene.X_WC.inverse()), tip_T_(scene.tools[0].tip.centre.e()) {}
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (!frame_.due(now)) return false;
    newest.t = now - Duration(20'000'000);
    newest.health = Health::ok;
    const double way = std::fmod(0.011 * std::max(0.0, seconds(newest.t.time_since_epoch()) - 1.0), 0.16);
    const double x = way < 0.08 ? way - 0.04 : 0.12 - way;
    newest.value = {0, X_CW_ * Pose<'W', 'T'>(Quat::Identity(), Vec3(x, 0.7 * x, 0.0115) - tip_T_)};
    return true;
  }

 private:
  Pose<'C', 'W'> X_CW_;
  Vec3 tip_T_;
  DueTimes frame_{120.0};
};

// The simulated machine adds its lag, delay and steps.
TEST(Edges, TheTwinStaysInsideOfACubeWithoutAHold) {
  models::Setup setup = test::shipped("hare");
  ObjectSpec& object = setup.scene.objects[0];
  object.surface = std::make_shared<const Mesh>(test::box(0.06, 0.06, 0.06));
  object.position = Vec3(0, 0, kHigh);
  object.rotation = Vec3::Zero();
  setup.scene.user.reset();
  setup.scene.display.reset();
  const Scene scene = trial::prepare_setup(setup);
  double outside = -1.0;
  trial::TrialOptions options{.seconds = 30.0};
  options.fit_out = [&](Rig& rig) { rig.tracker = std::make_unique<GlidingTool>(scene); };
  std::int64_t entered = 0;
  trial::Trial* made = nullptr;
  options.watch = [&](const trial::Glance& glance) {
    if (!made->state().entered) return;
    ++entered;
    const Object& cube = glance.scene.objects[0];
    outside = std::max(outside, cube.surface.nearest(cube.X_WO.inverse() * glance.truth.tip).distance + kTip);
  };
  trial::Trial trial(setup, options);
  made = &trial;
  const trial::TrialResult result = trial.run();
  EXPECT_GT(entered, 20'000);
  EXPECT_LE(outside, kGuard);
  EXPECT_TRUE(result.holds.empty()) << why_text(result.holds.front().second);
}

// A press beside an edge: the tip cannot reach the buffered point, but restoring ends.
TEST(Edges, APressBesideAnEdgeEnds) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> beside(-0.004, 0.0045);
  for (int press = 0; press < 30; ++press) {
    Loop loop = loop_of(test::mesh_scene(test::box(0.06, 0.06, 0.06), kHigh));
    const double x = 0.03 + beside(random), y = press % 2 == 0 ? 0.0 : 0.03 + beside(random);
    const auto put = [&](double gap) { loop.tool_tip = Point<'W'>(x, y, test::kTop + kToolRadius + gap); };
    put(0.02);
    loop.tick(1000);
    put(-0.003);
    loop.force = Vec<'W'>(0.3, -0.2, -4.0);
    loop.tick(500);
    loop.force = Vec<'W'>::zero();
    put(0.02);
    loop.tick(1000);
    EXPECT_EQ(loop.out.mode, Mode::follow) << "press " << press << " at " << x << " " << y;
    EXPECT_LE(loop.worst_outside, kGuard);
    const Point<'W'> still = loop.tip();
    loop.tick(100);
    EXPECT_LT((loop.tip() - still).norm(), 1e-6);  // no dithering
  }
}

// ---- room for the tip -----------------------------------------------------------------------------------

std::string refusal(const SceneSpec& spec) {
  return test::refusal([&] { (void)prepare(spec, RigSpec{}); });
}

TEST(Room, WhatIsThinnerThanTheTipIsRefusedWithItsPlace) {
  const std::string slab = refusal(test::mesh_scene(test::box(0.06, 0.06, 0.008), 0.004));
  EXPECT_THAT(slab, HasSubstr("object 'mesh' is thinner than the haptic-tip"));
  EXPECT_THAT(slab, HasSubstr("it is 8.0 mm; expected at least 11.0 mm"));
  EXPECT_THAT(slab, HasSubstr(", 4.0) mm"));  // the middle of the slab
  const std::string needle = refusal(test::mesh_scene(test::box(0.004, 0.004, 0.06), -0.022));
  EXPECT_THAT(needle, HasSubstr("it is 4.0 mm"));
  EXPECT_EQ(refusal(test::mesh_scene(test::box(0.06, 0.06, 0.012), 0.002)), "");
  for (const double side : {0.0115, 0.012, 0.016, 0.0165})  // meshes of any coarseness
    EXPECT_EQ(refusal(test::mesh_scene(test::box(side, side, side), 0.0)), "") << side;
  EXPECT_THAT(refusal(test::mesh_scene(test::box(0.0105, 0.03, 0.03), 0.0)), HasSubstr("it is 10.5 mm"));
  SceneSpec ball = test::ball_scene();
  ball.objects[0].radius = 0.005;
  EXPECT_THAT(refusal(ball), HasSubstr("thinner than the haptic-tip"));
}

TEST(Room, AnImpossibleTipIsSaidInNumbers) {
  RigSpec rig;
  rig.manipulator.tip_radius = 1e297;
  EXPECT_THAT(test::refusal([&] { (void)prepare(test::ball_scene(), rig); }),
              HasSubstr("expected at least 100000000000000.0 mm"));
}

TEST(Room, APartThatIsTooThinIsFound) {
  // A block with a fin of 4 mm on its top: 20 of 30 mm high, on both sides.
  const Mesh fin = test::prism({{0.0, -0.03},
                                {0.03, -0.03},
                                {0.03, 0.0},
                                {0.002, 0.0},
                                {0.002, 0.02},
                                {-0.002, 0.02},
                                {-0.002, 0.0},
                                {-0.03, 0.0},
                                {-0.03, -0.03}},
                               0.06);
  const Scene scene = prepare(test::mesh_scene(fin, 0.0), RigSpec{});
  const Room room = room_in(scene.objects[0], room_margin(scene), true);
  EXPECT_GE(room.deepest, room_margin(scene));
  EXPECT_GT(room.thin, 0.05);
  EXPECT_LT(room.thin, 0.5);
  EXPECT_NEAR(room.thinnest, 0.004, 1e-6);
  EXPECT_GT(room.thin_at.xyz[2], 0.0);
  const Scene cube = prepare(test::mesh_scene(test::box(0.06, 0.06, 0.06), kHigh), RigSpec{});
  EXPECT_EQ(room_in(cube.objects[0], room_margin(cube), true).thin, 0.0);  // an edge is not thin
}

// The last check before a machine that takes positions: a tip at the edge of the reach comes back.

// A ball on a floor. The reach is not convex: from much of its edge the straight line to the ball leads out.
Loop ball_on_a_floor() {
  SceneSpec scene = test::ball_scene();
  scene.objects.front().radius = 0.012;
  scene.objects.front().position = {0, 0, 0.001};
  SceneSpec floor = test::plane_scene();
  floor.objects.front().name = "floor";
  floor.objects.front().position = {0, 0, -0.008};
  scene.objects.push_back(floor.objects.front());
  return Loop(prepare(scene, test::exact_rig()));
}

TEST(Guard, ATipAtTheEdgeOfTheReachComesBack) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), far(0.06, 0.2), high(0.0, 0.06);
  for (int seed = 0; seed < 60; ++seed) {
    Loop loop = ball_on_a_floor();
    const double a = turn(random), r = far(random);
    loop.tool_tip = Point<'W'>(0, 0, 0.05);
    loop.tick(500);
    const Point<'W'> aside(r * std::cos(a), r * std::sin(a), high(random));
    for (int i = 1; i <= 500; ++i) {  // slower than a motion that counts as a leap
      loop.tool_tip = Point<'W'>(0, 0, 0.05) + (i / 500.0) * (aside - Point<'W'>(0, 0, 0.05));
      loop.tick();
    }
    loop.tick(2500);
    const double out = (loop.tip() - Point<'W'>(0, 0, 0.008)).norm();
    for (int i = 1; i <= 500; ++i) {
      loop.tool_tip = aside + (i / 500.0) * (Point<'W'>(0, 0, 0.05) - aside);
      loop.tick();
    }
    loop.tick(4000);
    EXPECT_GT(out, 0.02) << seed;
    EXPECT_LT((loop.tip() - Point<'W'>(0, 0, 0.008)).norm(), 2e-3)
        << "went to " << aside.xyz[0] << " " << aside.xyz[1] << " " << aside.xyz[2];
    EXPECT_TRUE(loop.always_reachable);
    EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  }
}

// Rounding must not brake the tip at the machine's greatest speed: it moves evenly in every direction of the
// target.
TEST(Guard, AtItsGreatestSpeedTheTipDoesNotStutter) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), up(-0.2, 0.4);
  int seen = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Loop loop(prepare(test::plane_scene(), test::exact_rig()));
    loop.tool_tip = Point<'W'>(0, 0, 0.08);
    loop.tick(1000);
    const double a = turn(random);
    const Vec3 step =
        0.08e-3 * Vec3(std::cos(a), std::sin(a), up(random)).normalized();  // 80 mm/s, and the tip 50
    const double most = loop.scene.reach.speed;
    double before = 0.0;
    for (int i = 0; i < 400; ++i) {
      loop.tool_tip = Point<'W'>(Vec3(loop.tool_tip.e() + step));
      loop.tick();
      const double speed = recall<CommandState>(loop.state).command_velocity.norm();
      if (before > most * (1.0 - 1e-6)) {
        ++seen;
        ASSERT_GT(speed, most * (1.0 - 1e-6)) << i;
      }
      before = speed;
    }
    EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  }
  EXPECT_GT(seen, 1000);
}

// A tip at the edge of the machine's reach, inside an object, goes on along that edge.

// Seed 24 of the session: the line to the tool leads through the ball, down to the shortest legs.
TEST(EdgeOfReach, IsLeftInsideOfAnObject) {
  TrialOptions options{.seed = 24, .seconds = 64.4};
  Trial trial(test::shipped("session"), options);
  double lowest = 0.0;
  while (trial.tick())
    if (trial.now().index > 62'000) lowest = std::min(lowest, trial.truth().tip.xyz[2]);
  EXPECT_LT(lowest, -0.022) << "it was at the edge";
  EXPECT_LT((trial.truth().tip - trial.truth().tool_tip).norm(), 0.020) << "and is under the tool by now";
}

}  // namespace
}  // namespace enc::trial
