// Whatever comes in, what goes out is within the limits. Seeded random inputs, and a child process that may
// not call the system.
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/control/step.h"
#include "core/shape/deformation/dent.h"
#include "tests/support/scenes.h"
#include "tests/support/spoil.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ENC_SANITIZED 1  // their runtime calls the system by itself
#else
#define ENC_SANITIZED 0
#endif

namespace enc {
namespace {

using test::Loop;

// The tool wanders over the objects and leaps now and then; forces come and go; one input in `spoil_every` is
// spoilt.
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
  test::SpoilOne count{wander.random, -1};
  fields(count, probe);
  loop.spoil = [&](Inputs& in) {
    const auto index = static_cast<std::size_t>(wander.random() % 2);
    const Object& object = loop.scene.objects[index];
    if (loop.k.index > 20 && wander.random() % 16 == 0)
      in.dent = {dent_of(object.surface, static_cast<std::int32_t>(index),
                         {object.X_WO.inverse() * loop.tool_tip, test::kToolRadius}),
                 loop.now() - Duration(15'000'000), Health::ok};
    if (spoil_every == 0 || wander.random() % spoil_every != 0) return;
    test::SpoilOne one{wander.random, static_cast<int>(wander.random() % static_cast<unsigned>(count.seen))};
    fields(one, in);
  };
  std::array<int, kModes> modes{};
  for (int i = 0; i < ticks; ++i) {
    wander.move(loop);
    loop.tick();
    ++modes[static_cast<std::size_t>(loop.out.mode)];
    ASSERT_TRUE(loop.out.tip.valid()) << "tick " << i;
    ASSERT_TRUE(loop.scene.reach.contains(loop.out.tip)) << "tick " << i << " z " << loop.tip().xyz[2];
    ASSERT_LE(loop.worst_speed, 1.0 + 1e-9) << "tick " << i;
    ASSERT_LE(loop.worst_acceleration, 1.0 + 1e-9) << "tick " << i;
    ASSERT_LE(loop.worst_outside, 50e-6) << "tick " << i;
  }
  EXPECT_GT(loop.worst_speed, 0.9);  // it did go to its limits
  EXPECT_GT(loop.worst_acceleration, 0.9);
  EXPECT_GT(loop.worst_outside, -1e-3);
  // Faults may keep a mode for long; without them all but those of the two programmes occur.
  for (int mode = 0; mode < kModes && spoil_every == 0; ++mode) {
    if (static_cast<Mode>(mode) == Mode::probe || static_cast<Mode>(mode) == Mode::travel) continue;
    EXPECT_GT(modes[static_cast<std::size_t>(mode)], 0) << mode_name(static_cast<Mode>(mode));
  }
}

TEST(StepProperty, CommandsStayWithinTheLimitsForAnyMotion) { run_wild(1, 0, 100'000); }
TEST(StepProperty, CommandsStayWithinTheLimitsForRareFaults) { run_wild(2, 50, 100'000); }
TEST(StepProperty, CommandsStayWithinTheLimitsForManyFaults) { run_wild(3, 3, 100'000); }

TEST(StepProperty, TheTipNeverLeavesTheObjectHoweverTheToolMoves) {
  // One ball, no force: the tip follows a tool that leaps about at random, also across the ball.
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
  EXPECT_GT(loop.worst_outside, -0.5e-3);  // as near to the surface as it waits: the inset
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
  // And the trap traps.
  const int trapped = in_strict_child([] { return getppid() > 0; });
  EXPECT_TRUE(WIFSIGNALED(trapped) && WTERMSIG(trapped) == SIGKILL);
}
#endif

}  // namespace
}  // namespace enc
