// Objects that a finger moves, with a finger on a given path: restitution, momentum, tiles, a running
// surface.
#include "core/control/world/moving.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/step.h"
#include "tests/support/by_hand.h"

namespace enc {
namespace {

constexpr double kTick = 1e-3;  // s

struct World {
  std::vector<ObjectSpec> specs;
  std::vector<Object> objects;
  std::vector<Mover> movers;
  std::array<MoverState, kMostMoving> moved{};
  Point<'W'> last;  // of the finger

  void add(const std::string& name, Surface surface, const Pose<'W', 'O'>& X_WO, const InteractionSpec& does,
           double stiffness = 800.0) {
    specs.emplace_back();
    specs.back().name = name;
    objects.push_back({std::move(surface), X_WO, {}});
    objects.back().interaction = does;
    objects.back().stiffness = stiffness;
  }
  void make() { movers = make_movers(specs, objects); }

  // A tick with a finger (a point) at p, which is nearest to object `index`. Return the force on it, N.
  double tick(std::int32_t index, const Point<'W'>& p) {
    const Object& object = objects[static_cast<std::size_t>(index)];
    const SurfacePoint at = object.surface.nearest(object.X_WO.inverse() * (p - shift_of(object, moved)));
    const Vec<'W'> normal = object.X_WO * at.normal;
    const double speed = last.finite() ? dot(last - p, normal) / kTick : 0.0;
    last = p;
    const double before = object.moving < 0 ? kUnset : moved[static_cast<std::size_t>(object.moving)].depth;
    const double sinks = std::isnan(before) ? 0.0 : (-at.distance - before) / kTick;
    move(movers, {index, -at.distance, normal, p, 0.0, speed, sinks, false}, kTick, moved);
    const MoverState& now = moved[static_cast<std::size_t>(object.moving)];
    return std::max(0.0, -at.distance) * object.stiffness * now.firmness;
  }
};

InteractionSpec hit(double restitution, double mass = 0.058) {
  InteractionSpec does{.kind = Interaction::hit, .mass = mass, .restitution = restitution, .travel = 10.0};
  return does;
}

// A ball at rest, met along its axis by a finger that goes on at `speed`.
struct Hit {
  double parted = 0.0, impulse = 0.0, momentum = 0.0, most = 0.0, least = 0.0;
  int ticks = 0;  // of touch
};
Hit hit_ball(double restitution, double mass, double stiffness, double speed, double start) {
  World world;
  world.add("ball", Surface{Sphere{0.033}}, Pose<'W', 'O'>::identity(), hit(restitution, mass), stiffness);
  world.make();
  Hit result;
  double x = -0.033 - 0.002 - start * speed * kTick;
  for (int i = 0; i < 5000; ++i, x += speed * kTick) {
    const double force = world.tick(0, {x, 0, 0});
    result.impulse += force * kTick;
    result.most = std::max(result.most, force);
    result.least = std::min(result.least, force);
    result.ticks += force > 0.0 ? 1 : 0;
  }
  result.parted = (world.moved[0].velocity.xyz[0] - speed) / speed;
  result.momentum = mass * world.moved[0].velocity.xyz[0];
  return result;
}

TEST(Bounce, IsTheRootOfItsLaw) {
  for (const double e : {0.05, 0.2, 0.5, 0.8, 0.99, 0.9985}) {
    const double c = bounce_of(e);
    EXPECT_GT(c, 0.0);
    EXPECT_LE(c, 1.0 / e);
    // Below this, 1 - c e is smaller than a double's resolution.
    if (e < 0.2) continue;
    EXPECT_NEAR(-std::log1p(-c * e) - c * e, 0.5 * c * c, 1e-8 * c) << e;
  }
  EXPECT_EQ(bounce_of(1.0), 0.0);
  EXPECT_NEAR(bounce_of(0.99899), bounce_of(0.99901), 1e-4);
}

TEST(HitBall, PartsWithItsRestitutionWhateverSpeedMassAndStiffness) {
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0})
    for (const double speed : {0.1, 0.3, 1.0})
      for (const double mass : {0.03, 0.058, 0.2})
        for (const double start : {0.0, 0.3, 0.7}) {
          const Hit result = hit_ball(e, mass, 800.0, speed, start);
          // The law aims at 0.95: it never gives back more than e.
          EXPECT_NEAR(result.parted / e, 0.95, 0.05)
              << e << " at " << speed << " m/s, " << mass << " kg " << start;
          EXPECT_NEAR(result.impulse, result.momentum, 1e-12);
          EXPECT_GT(result.ticks, 10);
          EXPECT_EQ(result.least, 0.0) << "it never pulls";
        }
}

// A finger that follows pushes once and lets the ball go, and no force remains.
TEST(HitBall, IsFeltOnceAndThenFlies) {
  World world;
  world.add("ball", Surface{Sphere{0.033}}, Pose<'W', 'O'>::identity(), hit(0.8));
  world.make();
  double x = -0.04;
  for (int i = 0; i < 300; ++i) world.tick(0, {x += 0.2 * kTick, 0, 0});
  EXPECT_NEAR(world.moved[0].velocity.xyz[0], 0.2 * (1.0 + 0.95 * 0.8), 0.2 * 0.04);
  const Vec<'W'> before = world.moved[0].shift;
  world.tick(0, {x, 0, 0});
  EXPECT_NEAR((world.moved[0].shift - before).norm(), world.moved[0].velocity.norm() * kTick, 1e-12);
  EXPECT_EQ(world.moved[0].firmness, 1.0);
}

TEST(HitBall, WaitsAtTheEndOfItsTravelUntilTheFingerIsClearOfItsPlace) {
  World world;
  InteractionSpec does = hit(0.8);
  does.travel = 0.05;
  world.add("ball", Surface{Sphere{0.033}}, Pose<'W', 'O'>::identity(), does);
  world.make();
  double x = -0.036;
  while (world.moved[0].velocity.norm() == 0.0) world.tick(0, {x += 0.2 * kTick, 0, 0});
  while (world.moved[0].velocity.norm() != 0.0) world.tick(0, {x += 0.2 * kTick, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.norm(), 0.05, 1e-12);
  for (int i = 0; i < 100; ++i) world.tick(0, {-0.033 - 0.019, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.norm(), 0.05, 1e-12) << "19 mm from where it belongs";
  world.tick(0, {-0.033 - 0.021, 0, 0});
  EXPECT_EQ(world.moved[0].shift.norm(), 0.0);
}

// Tiles that are pushed at their faces, which look towards -x of W: in O they move along -z.
InteractionSpec tile(double travel = 0.030) {
  InteractionSpec does{.kind = Interaction::shift};
  does.way = {0, 0, -2};  // of any length
  does.mass = 0.2;
  does.friction = 0.3;
  does.travel = travel;
  does.restitution = 0.4;
  return does;
}
Pose<'W', 'O'> facing_minus_x(double x, double y = 0.0) {
  return {Quat::FromTwoVectors(Vec3::UnitZ(), -Vec3::UnitX()), Vec3(x, y, 0)};
}
const Surface kTile{Button{0.02, 0.02, 0.02}};

TEST(Tile, FollowsTheFingerToItsEndAndStopsThere) {
  World world;
  world.add("tile", kTile, facing_minus_x(0.0), tile());
  world.make();
  double x = -0.002, force = 0.0;
  for (; x < 0.020; x += 0.05 * kTick) force = world.tick(0, {x, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.xyz[0], x, 0.003) << "it is before the finger";
  EXPECT_NEAR(force, 0.3, 0.2) << "friction";
  for (; x < 0.032; x += 0.05 * kTick) force = world.tick(0, {x, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.xyz[0], 0.030, 1e-12);
  EXPECT_EQ(world.moved[0].velocity.norm(), 0.0);
  EXPECT_NEAR(force, (x - 0.05 * kTick - 0.030) * 800.0, 0.1) << "like a wall";
  for (int i = 0; i < 100; ++i) world.tick(0, {-0.01, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.xyz[0], 0.030, 1e-12) << "it stays";
}

// A finger that goes on evenly hits the tile: they part with e times the speed of the hit.
TEST(Tile, PartsWithItsRestitution) {
  for (const double e : {0.4, 0.6, 0.8})
    for (const double mass : {0.05, 0.1, 0.2})
      for (const double speed : {0.1, 0.3}) {
        InteractionSpec does = tile(1.0);
        does.mass = mass;
        does.friction = 0.0;
        does.restitution = e;
        World world;
        world.add("tile", kTile, facing_minus_x(0.0), does);
        world.make();
        double x = -0.002, most = 0.0;
        for (int i = 0; i < 1500; ++i) {
          world.tick(0, {x += speed * kTick, 0, 0});
          most = std::max(most, world.moved[0].velocity.xyz[0]);
        }
        EXPECT_NEAR((most - speed) / speed / e, 1.0, 0.06) << e << ' ' << mass << " kg " << speed << " m/s";
      }
}

TEST(Tile, IsHeldByFriction) {
  World world;
  world.add("tile", kTile, facing_minus_x(0.0), tile());
  world.make();
  for (int i = 0; i < 500; ++i) world.tick(0, {0.9 * 0.3 / 800.0 * std::min(1.0, i / 100.0), 0, 0});
  EXPECT_EQ(world.moved[0].shift.norm(), 0.0);
}

// Given a push, it runs v^2 m / (2 friction) far.
TEST(Tile, RunsOutByFriction) {
  World world;
  world.add("tile", kTile, facing_minus_x(0.0), tile(1.0));
  world.make();
  world.moved[0].velocity = {0.1, 0, 0};
  for (int i = 0; i < 500; ++i) world.tick(0, {-0.5, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.xyz[0], 0.1 * 0.1 * 0.2 / 0.6, 0.1 * kTick);
  EXPECT_EQ(world.moved[0].velocity.norm(), 0.0);
}

TEST(Tile, DoesNotRunThroughItsNeighbour) {
  World world;
  world.add("first", kTile, facing_minus_x(0.0), tile());
  world.add("second", kTile, facing_minus_x(0.030), tile());         // 10 mm behind the first
  world.add("beside", kTile, facing_minus_x(0.030, 0.020), tile());  // next row, touching the second
  InteractionSpec wall{.kind = Interaction::slide};
  world.add("block", Surface{Sphere{0.010}}, Pose<'W', 'O'>::shift(0.080, 0, 0),
            wall);  // 20 mm behind the second
  world.make();
  const auto push = [&](std::int32_t index, double from, double to) {
    for (double x = from; x < to; x += 0.05 * kTick) world.tick(index, {x, index == 2 ? 0.020 : 0.0, 0});
  };
  push(0, -0.001, 0.015);
  EXPECT_NEAR(world.moved[0].shift.xyz[0], 0.010, 1e-9);
  EXPECT_EQ(world.moved[1].shift.norm(), 0.0);
  push(2, 0.029, 0.075);
  EXPECT_NEAR(world.moved[2].shift.xyz[0], 0.030, 1e-9) << "passes by";
  push(1, 0.029, 0.055);
  EXPECT_NEAR(world.moved[1].shift.xyz[0], 0.020, 1e-9) << "the block stands there";
  push(0, 0.009, 0.045);
  EXPECT_NEAR(world.moved[0].shift.xyz[0], 0.030, 1e-9) << "its way is free now";
}

TEST(Drum, RunsAtItsSpeedAndStaysWhereItIs) {
  World world;
  InteractionSpec does{.kind = Interaction::spin, .speed = 0.05};
  world.add("drum", kTile, facing_minus_x(0.0), does);
  world.make();
  for (int i = 0; i < 2000; ++i) world.tick(0, {0.001, 0, 0});
  EXPECT_NEAR(world.moved[0].shift.norm(), 0.100, 1e-9);
  EXPECT_NEAR(world.moved[0].velocity.norm(), 0.05, 1e-15);
  EXPECT_NEAR(world.moved[0].velocity.e().dot(Vec3(world.objects[0].X_WO.q() * Vec3::UnitX())), 0.05, 1e-15);
  EXPECT_EQ(shift_of(world.objects[0], world.moved).norm(), 0.0);
}

TEST(Movers, KeepTheirPlacesAndRefuseWhatCannotBe) {
  World world;
  world.add("wall", Surface{Plane{}}, Pose<'W', 'O'>::identity(), InteractionSpec{});
  world.add("ball", Surface{Sphere{0.01}}, Pose<'W', 'O'>::identity(), hit(0.5));
  world.make();
  EXPECT_EQ(world.objects[0].moving, -1);
  EXPECT_EQ(world.objects[1].moving, 0);
  EXPECT_EQ(world.movers[0].object, 1);

  const auto refused = [](InteractionSpec does, Surface surface = Surface{Sphere{0.01}},
                          double stiffness = 800.0) {
    World one;
    one.add("thing", std::move(surface), Pose<'W', 'O'>::identity(), does, stiffness);
    try {
      one.make();
    } catch (const Error& e) {
      return e.key() == "object.thing.behaviour";
    }
    return false;
  };
  InteractionSpec does = hit(0.5);
  EXPECT_FALSE(refused(does));
  EXPECT_TRUE(refused(does, Surface{Plane{}}));
  EXPECT_TRUE(refused(does, Surface{Sphere{0.01}}, kUnset));
  EXPECT_TRUE(refused(hit(0.0)));
  EXPECT_TRUE(refused(hit(1.2)));
  EXPECT_TRUE(refused(hit(0.5, -0.1)));
  does.travel = 0.0;
  EXPECT_TRUE(refused(does));
  does = tile();
  does.way = {0, 0, 0};
  EXPECT_TRUE(refused(does));
  does = tile();
  does.friction = -1.0;
  EXPECT_TRUE(refused(does));

  World many;
  for (std::size_t i = 0; i <= kMostMoving; ++i)
    many.add("ball" + std::to_string(i), Surface{Sphere{0.01}}, Pose<'W', 'O'>::identity(), hit(0.5));
  EXPECT_THROW(many.make(), Error);
}

// A ball that an arm's prop stands for, and that the finger hits.

using Bench = test::FingerBench;

// A ball, its prop at home, and a finger whose believed place the test sets.
struct Ball : Bench {
  Ball() : Bench("hit_ball", {"rig.tracker.prediction=\"hold\""}) {
    at(-0.080, 10);
    at(-0.010, 500);
  }
  [[nodiscard]] const MoverState& moved() const { return moved_in(loop.state)[0]; }
  // The prop goes on at `speed` under the finger, until they part or for `ticks`.
  int strike(double speed, int ticks = 100) {
    for (int i = 1; i <= ticks; ++i) {
      press_tip(speed * 1e-3 * i);
      loop.in.arm.value.velocity = Vec<'R'>(0, 0, -speed);
      at(-0.002);
      if (i > 10 && loop.out.mode != Mode::contact) return i;
    }
    return ticks;
  }
};

// A picture is 50 ms old, and a hit is over by then.
TEST(HitBall, IsHitByThePropAndNotByWhatIsBelieved) {
  Ball ball;
  ball.at(0.010, 200);
  EXPECT_EQ(ball.loop.out.contacts, 0);
  EXPECT_EQ(ball.moved().velocity.norm(), 0.0) << "the prop was not touched";
  Ball struck;
  const int ticks = struck.strike(0.2);
  EXPECT_EQ(struck.loop.out.contacts, 1);
  EXPECT_LT(ticks, 45);
  EXPECT_NEAR(struck.moved().velocity.norm(), 0.2 * (1.0 + 0.95 * 0.75), 0.02);
  struck.strike(0.2);
  EXPECT_EQ(struck.loop.out.contacts, 1) << "a ball that flies is not hit again";
}

// Two counts and one reading of 0.8 m/s must not set the prop in motion.
TEST(HitBall, OneWrongReadingSetsNothingInMotion) {
  Ball ball;
  ball.press_tip(0.08e-3);
  ball.loop.in.arm.value.velocity = Vec<'R'>(0, 0, -0.8);
  ball.at(-0.002);
  EXPECT_EQ(ball.loop.out.mode, Mode::contact);
  ball.loop.in.arm.value.velocity = Vec<'R'>::zero();
  double fastest = 0.0;
  for (int i = 0; i < 100; ++i) {
    ball.at(-0.002);
    fastest = std::max(fastest, recall<ImpedanceState>(ball.loop.state).aim.velocity.norm());
  }
  EXPECT_LT(fastest, 0.050);
}

// The ball gets the impulse that the arm is commanded along the normal.
TEST(HitBall, ItsMomentumIsTheImpulseOfWhatTheArmIsTold) {
  Ball ball;
  double impulse = 0.0;
  for (int i = 1; i <= 60; ++i) {
    ball.press_tip(0.2e-3 * i);
    ball.loop.in.arm.value.velocity = Vec<'R'>(0, 0, -0.2);
    ball.at(-0.002);
    if (ball.loop.out.mode == Mode::contact) impulse += 1e-3 * ball.pushed();
  }
  EXPECT_GT(impulse, 0.01);
  EXPECT_NEAR(impulse, 0.058 * ball.moved().velocity.norm(), 0.02 * impulse);
}

}  // namespace
}  // namespace enc
