// The output of step() is within the limits for any input; the hexapod's limits; and drawn surfaces from any
// pose.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/control/step.h"
#include "core/machine/hexapod.h"
#include "core/shape/deformation/dent.h"
#include "tests/support/by_hand.h"
#include "tests/support/scenes.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ENC_SANITIZED 1  // their runtime makes system calls
#else
#define ENC_SANITIZED 0
#endif

namespace enc {
namespace {

using test::Loop;

// ---- The output is within the limits for any input. Seeded random inputs, and a child process that may make
// no system call.

// The tool wanders over the objects and leaps now and then; forces come and go; one input in `spoil_every` is
// invalid.
struct Wander {
  std::mt19937_64 random;
  Vec3 at{0, 0, 0.05}, aim{0, 0, 0.05};
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  void move(Loop& loop) {
    if (random() % 300 == 0)
      aim = Vec3(0.08 * unit(random), 0.06 * unit(random),
                 0.03 + 0.05 * unit(random) + (random() % 8 == 0 ? 0.15 : 0.0));
    if (random() % 3000 == 0) at = aim;
    at += 0.02 * (aim - at);
    loop.tool_tip = Point<'W'>(at);
    if (random() % 200 == 0) loop.force = Vec<'W'>::zero();
    if (random() % 200 == 0)
      loop.force = Vec<'W'>(5 * unit(random), 5 * unit(random), -12 * std::abs(unit(random)));
    if (random() % 500 == 0) loop.tool_seen = random() % 4 != 0;
  }
};

void run_wild(std::uint64_t seed, unsigned spoil_every, int ticks) {
  Loop loop(prepare(test::two_balls(), RigSpec{}));
  Wander wander{
      std::mt19937_64(seed), {0, 0, 0.05}, {0, 0, 0.05}, std::uniform_real_distribution<double>(-1.0, 1.0)};
  Inputs probe;
  test::FieldSpoiler count{wander.random, -1};
  fields(count, probe);
  loop.spoil = [&](Inputs& in) {
    const auto index = static_cast<std::size_t>(wander.random() % 2);
    const Object& object = loop.scene.objects[index];
    if (loop.k.index > 20 && wander.random() % 16 == 0)
      in.dent = {dent_of(object.surface, static_cast<std::int32_t>(index),
                         {object.X_WO.inverse() * loop.tool_tip, test::kToolRadius}),
                 loop.now() - Duration(15'000'000), Health::ok};
    if (spoil_every == 0 || wander.random() % spoil_every != 0) return;
    test::FieldSpoiler one{wander.random,
                           static_cast<int>(wander.random() % static_cast<unsigned>(count.seen))};
    fields(one, in);
  };
  std::array<int, kModes> modes{};
  for (int i = 0; i < ticks; ++i) {
    wander.move(loop);
    loop.tick();
    ++modes[static_cast<std::size_t>(loop.out.mode)];
    ASSERT_TRUE(loop.out.manipulator.tip.valid()) << "tick " << i;
    ASSERT_TRUE(loop.scene.reach.contains(loop.out.manipulator.tip))
        << "tick " << i << " z " << loop.tip().xyz[2];
    ASSERT_LE(loop.worst_speed, 1.0 + 1e-9) << "tick " << i;
    ASSERT_LE(loop.worst_acceleration, 1.0 + 1e-9) << "tick " << i;
    ASSERT_LE(loop.worst_outside, 50e-6) << "tick " << i;
  }
  EXPECT_GT(loop.worst_speed, 0.9);  // it reached its limits
  EXPECT_GT(loop.worst_acceleration, 0.9);
  EXPECT_GT(loop.worst_outside, -1e-3);
  // Faults may prolong a mode; without them all modes but those of the two programmes occur.
  for (int mode = 0; mode < kModes && spoil_every == 0; ++mode) {
    if (static_cast<Mode>(mode) == Mode::probe || static_cast<Mode>(mode) == Mode::travel) continue;
    EXPECT_GT(modes[static_cast<std::size_t>(mode)], 0) << mode_name(static_cast<Mode>(mode));
  }
}

TEST(StepProperty, CommandsStayWithinTheLimitsForAnyMotion) { run_wild(1, 0, 100'000); }
TEST(StepProperty, CommandsStayWithinTheLimitsForRareFaults) { run_wild(2, 50, 100'000); }
TEST(StepProperty, CommandsStayWithinTheLimitsForManyFaults) { run_wild(3, 3, 100'000); }

TEST(StepProperty, TheTipNeverLeavesTheObjectHoweverTheToolMoves) {
  // One ball, no force: the tip follows a tool that leaps at random, also across the ball.
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 100'000; ++i) {
    if (random() % 100 == 0) {
      Vec3 n(unit(random), unit(random), 0.4 + unit(random));
      n.normalize();
      loop.tool_tip = Point<'W'>(Vec3(Vec3(0, 0, test::kTop - test::kBallRadius) + 0.05 * n));
    }
    loop.tick();
    ASSERT_LT(loop.worst_outside, 0.0) << "tick " << i;
    ASSERT_NE(loop.out.mode, Mode::hold) << why_text(loop.out.why);
  }
  EXPECT_GT(loop.worst_outside, -0.5e-3);  // as near to the surface as the waiting tip: the inset
  EXPECT_GT(loop.worst_speed, 0.99);
}

TEST(StepProperty, TheSameInputsGiveTheSameState) {
  std::array<std::uint64_t, 2> hashes{};
  for (std::uint64_t& value : hashes) {
    Loop loop(prepare(test::two_balls(), RigSpec{}));
    Wander wander{
        std::mt19937_64(9), {0, 0, 0.05}, {0, 0, 0.05}, std::uniform_real_distribution<double>(-1.0, 1.0)};
    StateHash hash;
    for (int i = 0; i < 5000; ++i) {
      wander.move(loop);
      loop.tick();
      add_tick(hash, loop.state, loop.out);
    }
    value = hash.value;
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

#if !ENC_SANITIZED
// Strict seccomp lets a process read, write and exit; any other call kills it with SIGKILL.
int in_strict_child(const std::function<bool()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) syscall(SYS_exit, 77);
    syscall(SYS_exit, work() ? 0 : 1);  // not exit_group, which strict mode forbids
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(StepProperty, MakesNoSystemCall) {
  std::vector<Inputs> inputs;
  std::vector<Tick> ticks;
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  for (int i = 0; i < 1000; ++i) {
    loop.tool_tip = Point<'W'>(0, 0, 0.030 - 2.5e-5 * i);
    loop.force = Vec<'W'>(0, 0, i > 800 ? -5.0 : 0.0);
    loop.tick();
    inputs.push_back(loop.in);
    ticks.push_back(loop.k);
  }
  ASSERT_EQ(loop.out.mode, Mode::contact);
  const int status = in_strict_child([&] {
    State state;
    Outputs out;
    for (std::size_t i = 0; i < inputs.size(); ++i) step(loop.scene, ticks[i], inputs[i], state, out);
    return out.mode == Mode::contact;
  });
  ASSERT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  // The trap works.
  const int trapped = in_strict_child([] { return getppid() > 0; });
  EXPECT_TRUE(WIFSIGNALED(trapped) && WTERMSIG(trapped) == SIGKILL);
}
#endif

// ---- The hexapod.

// Reachable poses, drawn over the catalogue's travels about the pivot and kept if the machine reaches them.
struct RandomPose {
  const Hexapod& machine;
  std::mt19937_64 random;
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  Pose<'R', 'H'> draw() {
    for (;;) {
      const Quat q = Eigen::AngleAxisd(0.26 * unit(random), Vec3::UnitX()) *
                     Eigen::AngleAxisd(0.26 * unit(random), Vec3::UnitY()) *
                     Eigen::AngleAxisd(0.52 * unit(random), Vec3::UnitZ());
      const Vec3 pivot(0.080 * unit(random), 0.070 * unit(random), 0.180 + 0.026 * unit(random));
      const Pose<'R', 'H'> X_RH(q, Vec3(pivot + q * Vec3(0, 0, 0.160)));
      if (machine.limit(X_RH) == ReachLimit::none) return X_RH;
    }
  }
};

// Both quaternions of one rotation are the same pose.
double turn_between(const Pose<'R', 'H'>& a, const Pose<'R', 'H'>& b) {
  return 2.0 * (a.q().conjugate() * b.q()).vec().norm();
}

TEST(HexapodProperty, ForwardAfterInverseIsTheSamePose) {
  const Hexapod machine{HexapodGeometry{}};
  RandomPose poses{machine, std::mt19937_64(1)};
  double worst = 0.0, worst_turn = 0.0;
  int most_steps = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Pose<'R', 'H'> X_RH = poses.draw();
    const auto found = machine.forward(machine.inverse(X_RH), machine.zero());
    ASSERT_TRUE(found) << i;
    worst = std::max(worst, (found->X_RH.p() - X_RH.p()).norm());
    worst_turn = std::max(worst_turn, turn_between(found->X_RH, X_RH));
    most_steps = std::max(most_steps, found->steps);
  }
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(worst_turn, 1e-8);  // 1e-9 m at 0.1 m
  RecordProperty("most_newton_steps_from_zero", most_steps);
}

TEST(HexapodProperty, AtMostFourNewtonStepsFromATenthOfAMillimetre) {
  const Hexapod machine{HexapodGeometry{}};
  RandomPose poses{machine, std::mt19937_64(2)};
  int most = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Pose<'R', 'H'> X_RH = poses.draw();
    const Vec3 away =
        Vec3(poses.unit(poses.random), poses.unit(poses.random), poses.unit(poses.random)).normalized();
    const Pose<'R', 'H'> guess(X_RH.q(), Vec3(X_RH.p() + 1e-4 * away));
    const auto found = machine.forward(machine.inverse(X_RH), guess);
    ASSERT_TRUE(found) << i;
    most = std::max(most, found->steps);
  }
  EXPECT_LE(most, 4);
}

TEST(HexapodProperty, WorkspaceWithoutTurnsIs160By140By50) {
  // Computes the extents of all places in reach of the unturned platform. The grid is 1 mm (x, y) and 0.5 mm
  // (z); a search then finds each end to 1e-6 m.
  const Hexapod machine{HexapodGeometry{}};
  const auto ok = [&](const Vec3& p) {
    return machine.limit({Quat::Identity(), Vec3(machine.zero().p() + p)}) == ReachLimit::none;
  };
  Vec3 most = Vec3::Zero(), least = Vec3::Zero();
  const auto outward = [&](Vec3 p, int axis, double sign) {
    for (double step = 1e-3; step > 5e-7; step *= 0.5)
      while (ok(p + sign * step * Vec3::Unit(axis))) p(axis) += sign * step;
    return p(axis);
  };
  for (int ix = -90; ix <= 90; ++ix)
    for (int iy = -80; iy <= 80; ++iy)
      for (int iz = -60; iz <= 60; ++iz) {
        const Vec3 p(ix * 1e-3, iy * 1e-3, iz * 5e-4);
        if (!ok(p)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const double near = axis == 2 ? 1e-3 : 1.5e-3;
          if (p(axis) > most(axis) - near) most(axis) = std::max(most(axis), outward(p, axis, 1.0));
          if (p(axis) < least(axis) + near) least(axis) = std::min(least(axis), outward(p, axis, -1.0));
        }
      }
  const Vec3 extent = most - least;
  RecordProperty("x_um", static_cast<int>(extent.x() * 1e6));
  RecordProperty("y_um", static_cast<int>(extent.y() * 1e6));
  RecordProperty("z_um", static_cast<int>(extent.z() * 1e6));
  EXPECT_NEAR(extent.x() / 0.160, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.y() / 0.140, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.z() / 0.050, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.prod() / 1.12e-3, 1.0, 0.02)
      << extent.transpose();  // the paper's volume is that of its bounding box
}

// ---- The drawn surface for any tip in any pose.

// Depth of a point inside a tip, m; negative outside.
double inside(const Tip<'O'>& tip, const Vec3& p) {
  const Vec3 from = p - tip.centre.e();
  const Vec3 axis = tip.axis.e();
  const double along = from.dot(axis);
  if (tip.shape == TipShape::edge) {
    const double at = std::clamp(along, -0.5 * tip.length, 0.5 * tip.length);
    return tip.radius - (from - at * axis).norm();
  }
  if (tip.shape == TipShape::cone) {
    const double beside = (from - along * axis).norm();
    if (along + beside * std::tan(tip.half_angle) > 0.0)
      return tip.radius + along * std::sin(tip.half_angle) - beside * std::cos(tip.half_angle);
  }
  return tip.radius - from.norm();
}

struct Case {
  std::mt19937_64 random;
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Vec3 direction() {
    Vec3 v;
    do v = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return v.normalized();
  }
  Tip<'O'> tip(double zero, Vec3& n) {
    n = zero > 0.0 ? direction() : Vec3(0, 0, 1);
    Tip<'O'> tip{Point<'O'>(), uniform(0.0003, 0.010), static_cast<TipShape>(random() % 3)};
    tip.axis = Vec<'O'>(direction());
    if (tip.shape == TipShape::cone) {
      tip.half_angle = uniform(0.1, 1.3);
      const double tilt = uniform(0.0, 1.4 - tip.half_angle);
      tip.axis = Vec<'O'>(Vec3(std::cos(tilt) * n + std::sin(tilt) * n.unitOrthogonal()));
    }
    if (tip.shape == TipShape::edge) tip.length = uniform(0.001, 0.040);
    const double lift = tip.radius - uniform(1e-5, 0.006);
    tip.centre = Point<'O'>(Vec3((zero + lift) * n));
    return tip;
  }
};

void any_pose(const Surface& surface, double zero, std::uint64_t seed) {
  Case pick{std::mt19937_64(seed)};
  double deepest_inside = -1.0;
  int on_tip = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec3 n;
    Tip<'O'> tip = pick.tip(zero, n);
    DentSample dent = dent_of(surface, 0, tip);
    if (dent.depth > 0.010) {  // an inclined edge: lift it
      tip.centre = tip.centre + (dent.depth - 0.004) * Vec<'O'>(n);
      dent = dent_of(surface, 0, tip);
    }
    if (!(dent.depth > 0.0) || dent.depth > 0.010) continue;
    const DentField<double> field = dent_field(surface, dent);
    const Vec3 under = deepest(surface, tip).at.point.e();
    for (int k = 0; k < 40; ++k) {
      const SurfacePoint at =
          surface.nearest(Point<'O'>(Vec3(under + pick.uniform(0, 0.02) * pick.direction())));
      const DisplacedPoint to = displaced(field, at.point, at.normal);
      const double in = inside(tip, to.point.e());
      deepest_inside = std::max(deepest_inside, in);
      on_tip += in > -1e-9 ? 1 : 0;
      ASSERT_GE(to.by, 0.0);
      ASSERT_LE(to.by, dent.depth * (1.0 + 1e-6) + 1e-9)
          << "convex objects: nowhere more than under the tool";
      ASSERT_NEAR(to.normal.norm(), 1.0, 1e-12);
      ASSERT_NEAR(dented_distance(surface, dent, to.point), 0.0, 1e-8);
      const Vec<'O'> up = 20e-6 * Vec<'O'>(Vec3(Vec3::Map(field.n.data())));
      ASSERT_GT(dented_distance(surface, dent, to.point + up), 0.0);
      ASSERT_LT(dented_distance(surface, dent, to.point - up), 0.0);
    }
  }
  EXPECT_LE(deepest_inside, 1e-6);
  EXPECT_GT(on_tip, 1000);
}

TEST(DentProperty, NothingOfABallIsInsideTheTipAndTheSignIsRight) {
  any_pose(Surface(Sphere{0.033}), 0.033, 1);
}
TEST(DentProperty, NothingOfAPlaneIsInsideTheTipAndTheSignIsRight) { any_pose(Surface(Plane{}), 0.0, 2); }

TEST(DentProperty, TheFieldIsContinuousAndTheContactMovesByTheDepth) {
  const Surface ball(Sphere{0.033});
  Case pick{std::mt19937_64(3)};
  for (int i = 0; i < 300; ++i) {
    Vec3 n;
    const Tip<'O'> tip = pick.tip(0.033, n);
    const DentSample dent = dent_of(ball, 0, tip);
    if (!(dent.depth > 0.0) || dent.depth > 0.010) continue;
    const DentField<double> field = dent_field(ball, dent);
    const SurfacePoint contact = deepest(ball, tip).at;
    ASSERT_NEAR(displaced(field, contact.point, contact.normal).by, dent.depth, 1e-9);
    // Away along any great circle: a step of 1 um moves the point by a few at most, the last step not at all.
    const Vec3 up = contact.normal.e();
    const Vec3 side = (pick.direction().cross(up)).normalized();
    double before = dent.depth;
    for (int k = 0; k <= 6000; ++k) {
      const double polar = 1e-6 * k * 10 / 0.033;
      const Vec3 out = std::cos(polar) * up + std::sin(polar) * side;
      const double now = displaced(field, Point<'O'>(Vec3(0.033 * out)), Vec<'O'>(out)).by;
      ASSERT_NEAR(now, before, 40e-6) << k;
      before = now;
    }
    if (tip.shape == TipShape::sphere) {
      ASSERT_EQ(before, 0.0);
    }
  }
}

}  // namespace
}  // namespace enc
