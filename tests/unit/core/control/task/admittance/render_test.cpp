// Rendering: each mode ends with its cause (mode.h); the damper; a tip that comes late; re-tare.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/control/task/admittance/damping.h"
#include "core/machine/loop_model.h"
#include "tests/support/by_hand.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::kTipRadius, test::kToolRadius, test::kTop, test::Loop;

Point<'W'> at_gap(double gap) { return {0, 0, kTop + kToolRadius + gap}; }

// A tool that was clear and now presses with 5 N at this gap.
Loop pressed(double gap, const SceneSpec& scene = test::plane_scene()) {
  Loop loop(prepare(scene, test::exact_rig()));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(gap);
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  return loop;
}

// A sensor whose zero drifts by 0.02 N during a press. The object is so soft that this is more than the leave
// gap, and has the damper that it needs.
TEST(ModeEnds, AContactBehindADamperWhoseZeroHasDrifted) {
  RigSpec rig = test::exact_rig();
  rig.admittance.damping = Damping::observed;
  rig.force.threshold = 0.0;
  rig.contact.softest = 0.0;
  Loop loop(prepare(test::plane_scene(test::spring(15.0)), rig));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.004);
  loop.force = Vec<'W'>(0, 0, -0.3);
  loop.tick(3000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.force_zero = Vec<'F'>(0, 0, -0.02);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = at_gap(0.050);
  loop.tick(3000);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  // Also without a tool that is seen to leave: after 5 s.
  Loop blind(prepare(
      [] {
        SceneSpec spec = test::plane_scene(test::spring(15.0));
        spec.tracker.reset();
        spec.tools.clear();
        return spec;
      }(),
      rig));
  blind.tick(1500);
  blind.force = Vec<'W'>(0, 0, -0.3);
  blind.tick(3000);
  ASSERT_EQ(blind.out.mode, Mode::contact);
  blind.force_zero = Vec<'F'>(0, 0, -0.02);
  blind.force = Vec<'W'>::zero();
  blind.tick(7500);
  EXPECT_NE(blind.out.mode, Mode::contact);
}

// A touch without force: the tool comes to the surface and goes back to 5 mm.
TEST(ModeEnds, AContactInWhichNoForceWasFelt) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.0001);
  loop.tick(2);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = at_gap(0.005);
  loop.tick(400);
  EXPECT_EQ(loop.out.mode, Mode::contact);  // the tool may only be coming
  loop.tick(300);
  EXPECT_EQ(loop.out.mode, Mode::follow);
}

// A zero that drifts during a press, and a tool that then waits 8.5 mm away: the force that remains is no
// touch.
TEST(ModeEnds, AContactOfAToolThatIsSeenToBeClear) {
  for (const double drift : {0.06, 0.1, 0.2, 1.0}) {
    Loop loop = pressed(-0.002);
    ASSERT_EQ(loop.out.mode, Mode::contact);
    loop.force_zero = Vec<'F'>(0, 0, -drift);
    loop.force = Vec<'W'>::zero();
    loop.tool_tip = at_gap(0.0085);
    loop.tick(1500);
    EXPECT_EQ(loop.out.mode, Mode::follow) << drift;
    EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.xyz[2], -drift, 0.02)
        << drift;  // and it is learnt anew
    const std::int32_t contacts = loop.out.contacts;
    loop.tick(5000);
    EXPECT_EQ(loop.out.contacts, contacts) << drift;
  }
}

SceneSpec two_tools() {
  SceneSpec spec = test::plane_scene();
  ToolSpec other = spec.tools.front();
  other.name = "other";
  for (Vec3& marker : other.markers) marker *= 1.3;
  spec.tools.push_back(other);
  return spec;
}

// A contact whose own tool is hidden from here on, while another one is seen at this gap.
Loop hidden(double gap) {
  Loop loop = pressed(-0.002, two_tools());
  EXPECT_EQ(loop.out.mode, Mode::contact);
  loop.tool = 1;
  loop.tool_tip = at_gap(gap);
  return loop;
}

// The tool vanishes as it lets go, another one is seen 150 mm away, and the zero is off: no cause is left.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhileAnotherIsSeenClear) {
  for (const double drift : {0.06, 0.12, 0.5, 2.0}) {
    SCOPED_TRACE(drift);
    Loop loop = hidden(0.150);
    loop.force_zero = Vec<'F'>(0, 0, -drift);
    loop.force = Vec<'W'>::zero();
    loop.tick(drift < 0.3 ? 8000 : 63'000);
    EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
    const std::int32_t contacts = loop.out.contacts;
    loop.tick(20'000);
    EXPECT_EQ(loop.out.mode, Mode::away);
    EXPECT_EQ(loop.out.contacts, contacts);
  }
}

// The second tool lies on the object's edge, where it touches nothing.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhileAnotherIsNear) {
  Loop loop = hidden(0.0029);
  loop.force_zero = Vec<'F'>(0, 0, -0.12);
  loop.force = Vec<'W'>::zero();
  bool over = false;
  for (int i = 0; i < 65'000 && !over; ++i) {
    loop.tick();
    over = loop.out.mode != Mode::contact;
  }
  EXPECT_TRUE(over);
}

// Poses that are late for 60 ms, every 4 s.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhilePosesAreLate) {
  Loop loop = hidden(0.150);
  loop.force_zero = Vec<'F'>(0, 0, -0.12);
  loop.force = Vec<'W'>::zero();
  int ticks = 0;
  auto last = Inputs{}.tool;
  loop.spoil = [&](Inputs& in) {
    if (ticks++ % 4000 < 60)
      in.tool = last;
    else
      last = in.tool;
  };
  loop.tick(9000);
  EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
}

// A hand that presses varies its force: its contact stays, though its tool is hidden and another one is in
// view.
TEST(ModeEnds, NotAContactWhoseForceVariesWhileItsToolIsHidden) {
  for (const double force : {0.5, 1.0, 3.0}) {
    Loop loop = hidden(0.150);
    for (int i = 0; i < 100'000; ++i) {
      loop.force = Vec<'W'>(0, 0, -force * (1.0 - 0.04 * std::sin(2e-3 * i)));  // 0.3 Hz
      loop.tick();
      ASSERT_EQ(loop.out.mode, Mode::contact) << force << " N, " << i;
    }
    EXPECT_EQ(loop.out.contacts, 1);
  }
}

// A hand so still that its contact ends: the zero must not learn its force while its tool is hidden.
TEST(ModeEnds, WithoutLearningTheForceOfAHiddenHand) {
  for (const double force : {0.2, 2.0}) {
    Loop loop = hidden(0.150);
    loop.force = Vec<'W'>(0, 0, -force);
    loop.tick(63'000);
    EXPECT_EQ(loop.out.mode, Mode::away);
    loop.tick(20'000);
    EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-3) << force;
    loop.tool = 0;
    loop.tool_tip = at_gap(0.150);  // and the zero learns again when that tool is seen clear
    loop.force = Vec<'W'>::zero();
    loop.force_zero = Vec<'F'>(0, 0, -0.03);
    loop.tick(20'000);
    EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.xyz[2], -0.03, 0.005) << force;
  }
}

// Only the gripper's tool is in view when the tip is back: there is no tool to follow.
TEST(ModeEnds, RestoringWithNoToolInViewEndsInAway) {
  SceneSpec spec = two_tools();
  spec.gripper.emplace().tool = "other";
  Loop loop(prepare(spec, test::exact_rig()));
  loop.spoil = [&loop](Inputs& in) {
    in.grip = {{GripPhase::closed, 0.006, 100.0, true}, loop.now(), Health::ok};
  };
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.002);
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact) << why_text(loop.out.why);
  loop.force = Vec<'W'>::zero();
  loop.tool = 1;
  for (int i = 0; i < 8000; ++i) {
    loop.tick();
    ASSERT_NE(loop.out.mode, Mode::hold) << i << ": " << why_text(loop.out.why);
  }
  EXPECT_EQ(loop.out.mode, Mode::away);
}

// A tip that never returns to its place and never stands still: noise of a machine, or a surface in between.
TEST(ModeEnds, RestoringATipThatNeverStands) {
  Loop loop = pressed(-0.001);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = at_gap(0.02);
  loop.spoil = [&](Inputs& in) {
    in.tip.value.velocity = Vec<'R'>(0, 0, 1e-3);
    in.tip.value.X_RH.xyz[2] -= 10e-6;
  };
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::restore);
  loop.tick(1500);
  EXPECT_EQ(loop.out.mode, Mode::follow);
}

// The damper beside a rendered object: its law worked by hand, its measurement, and its decay.

constexpr double kPi = std::numbers::pi;
constexpr double kDt = 1e-3;

double gain_of(double hz) { return 1.0 - std::exp(-2.0 * kPi * hz * kDt); }

// Filter 5 Hz, servo 15 Hz and 0.8, dead time 5 ms; commands 0.32 m/s^2 along the normal.
DampingLaw law(const AdmittanceRig& rig = {}) { return {rig, LoopModel{}, gain_of(5.0), 0.32, kDt}; }

Response spring(double stiffness) {
  ResponseSpec spec;
  spec.press = spec.release = {stiffness, 0, 0, 0};
  spec.limit = 0.02;
  return {spec, 0.0};
}

TEST(Damping, LagIsTheSumOfItsParts) {
  // 1 / (2 pi 5) + 2 * 0.8 / (2 pi 15) + 0.005 + 2 ticks
  EXPECT_NEAR(law().lag(), 0.031831 + 0.016977 + 0.005 + 0.002, 1e-6);
}

TEST(Damping, OneStepOfTheDamperByHand) {
  // k = 100 N/m, b = 10 N s/m: b/k = 0.1 s; the spring carries dt / (dt + b/k) of 1 N after one tick.
  const Response object = spring(100.0);
  EXPECT_NEAR(law().carry(object, ResponseState{}, 0.0, 1.0, 10.0, 0.02), 1e-3 / 0.101, 1e-12);
  // The spring carries half already, at 5 mm: a tick adds half of the share that it adds from zero.
  ResponseState half;
  object.deflection(half, 0.5);
  EXPECT_NEAR(law().carry(object, half, 0.5, 1.0, 10.0, 0.02), 0.5 + 0.5e-3 / 0.101, 1e-12);
}

TEST(Damping, NoDamperCarriesNothing) {
  const Response object = spring(100.0);
  EXPECT_EQ(law().carry(object, ResponseState{}, 0.0, 0.7, 0.0, 0.02), 0.7);
  // The tip does not move at the limit, so the damper is zero.
  ResponseState at_limit;
  object.deflection(at_limit, 2.0);
  EXPECT_EQ(law().carry(object, at_limit, 2.0, 3.0, 10.0, 0.02), 3.0);
}

TEST(Damping, SettlesWithDampingOverStiffness) {
  const Response object = spring(100.0);
  ResponseState at;
  double carried = 0.0;
  for (int i = 0; i < 100; ++i) {  // b/k = 0.1 s
    carried = law().carry(object, at, carried, 1.0, 10.0, 0.02);
    object.deflection(at, carried);
  }
  EXPECT_NEAR(carried, 1.0 - std::exp(-1.0), 0.002);
  EXPECT_NEAR(at.deflection, carried / 100.0, 1e-9);
}

// A tip that swings by `amplitude` at 4 Hz against a spring of k; the force is low-passed like the depth.
double swing(const DampingLaw& damping, Swing& seen, double k, double amplitude, double seconds) {
  double force = 0.0, b = 0.0;
  for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
    const double depth = amplitude * std::sin(2.0 * kPi * 4.0 * i * kDt);
    force += gain_of(5.0) * (-k * depth - force);
    b = damping.observe(seen, force, depth);
  }
  return b;
}

TEST(Damping, SeesTheStiffnessThatItSwingsAgainst) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-3, 3.0);
  // Low-pass (5 Hz) and high-pass (1 Hz) leave this part of 1 mm at 4 Hz: 1 / sqrt(1 + 0.64) / sqrt(1 +
  // 1/16).
  const double moved = 0.5e-6 / 1.64 / 1.0625;
  EXPECT_NEAR(seen.moved, moved, 0.15 * moved);
  EXPECT_NEAR(seen.exchanged, 500.0 * seen.moved, 1e-3 * 500.0 * seen.moved);
  EXPECT_NEAR(seen.stiffness, 500.0, 2.0);
}

TEST(Damping, IsTheRuleTimesTheMargin) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  const double b = swing(damping, seen, 500.0, 1e-3, 3.0);
  const double wide = 2.0 * std::sqrt(std::sqrt(2.0 * seen.moved) / 0.32);
  EXPECT_NEAR(b, 2.0 * (2.0 / kPi) * (damping.lag() + wide) * seen.stiffness, 1e-9);
  AdmittanceRig weak{.most_damping = 20.0};
  Swing again = law(weak).begin(1e6, 0.0, 0.0);
  EXPECT_EQ(swing(law(weak), again, 500.0, 1e-3, 3.0), 20.0);
}

TEST(Damping, ForgetsWhenItIsCalm) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-3, 3.0);
  for (int i = 0; i < 3000; ++i) damping.observe(seen, 0.0, 0.0);  // the rest of the ringing in the filters
  const double before = seen.stiffness;
  for (int i = 0; i < 1000; ++i) damping.observe(seen, 0.0, 0.0);
  EXPECT_NEAR(seen.stiffness / before, std::exp(-1.0), 1e-3);  // calm_time is 1 s
}

TEST(Damping, AUserWhoPushesIsNoSwing) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  EXPECT_EQ(swing(damping, seen, -500.0, 1e-3, 3.0), 0.0);  // force rises with depth: the object yields
  EXPECT_LT(seen.exchanged, 0.0);
}

TEST(Damping, SmallerThanTheLeastSwingCountsLittle) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-6, 3.0);
  EXPECT_LT(seen.stiffness, 1.0);
}

TEST(Damping, BeginsWithTheHandOnWhatIsTooSoft) {
  const DampingLaw damping = law();
  const double lowest = lowest_stable_stiffness(LoopModel{});
  EXPECT_EQ(damping.begin(0.9 * lowest, 0.0, 0.0).stiffness, LoopModel{}.hand_stiffness);
  EXPECT_EQ(damping.begin(1.1 * lowest, 0.0, 0.0).stiffness, 0.0);
}

// A tip that comes late to a tool that is inside already.

Point<'W'> at(double x, double gap) { return {x, 0, kTop + kToolRadius + gap}; }

// The tip waits 30 mm beside the place of the next tool pose, this deep inside. Return the least distance of
// the two surfaces until the tip is under the tool.
double least_clearance(Loop& loop, double depth) {
  loop.tool_tip = at(0.030, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.0, -depth);
  double least = 1.0;
  for (int i = 0; i < 1500; ++i) {
    loop.tick();
    EXPECT_EQ(loop.out.mode, Mode::contact) << i;
    if (std::abs(loop.tip().xyz[0]) < 0.6e-3) break;
    least = std::min(least, (loop.tip() - loop.tool_tip).norm() - kTipRadius - kToolRadius);
  }
  return least;
}

TEST(Below, ATipThatIsLateMeetsItsToolFromBelowAndNotFromTheSide) {
  for (const double depth : {1e-4, 1e-3, 4e-3, 8e-3}) {  // the object gives way by 6 mm
    Loop loop(prepare(test::plane_scene(), test::exact_rig()));
    EXPECT_GT(least_clearance(loop, depth), 1e-3) << depth;
    EXPECT_EQ(loop.out.deflection, 0.0) << "nothing has pressed the object";
    loop.tick(1000);
    EXPECT_NEAR(loop.tip().xyz[0], 0.0, 1e-6);
    EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius, 1e-5) << "up, as nothing pushes it down";
    EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-6);
    EXPECT_TRUE(loop.always_reachable);
  }
}

// A tool whose force is felt on the way is there: its object answers at once, at the place of the tool.
TEST(Below, EndsWhereForceIsFelt) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at(0.030, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.0, -4e-3);
  loop.tick(400);
  ASSERT_LT(loop.tip().xyz[2], kTop - kTipRadius - 5e-3);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  EXPECT_NEAR(loop.out.deflection, 1e-3, 0.05e-3);  // 2 N, 2 N/mm, less the threshold
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - loop.out.deflection, 1e-5);
}

// A touch that misses the middle of the tip does not count as late.
TEST(Below, IsNotWhereTheTwoCanMeet) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at(0.0, 0.02);
  loop.tick(1500);
  loop.tool_tip = at(0.006, -1e-4);
  loop.tick(100);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius, 1e-5);
}

// Re-tare by windows: the zero follows the sensor while nothing touches, and excludes every touch.

test::Loop loop_of(Tare tare) {
  RigSpec rig;
  rig.force.tare = tare;
  SceneSpec spec = test::plane_scene();
  spec.tracker.reset();
  spec.tools.clear();
  return test::Loop(prepare(spec, rig));
}

TEST(Retare, FollowsAZeroWithinThreeWindows) {
  test::Loop loop = loop_of(Tare::window);
  loop.tick(1000);
  loop.force_zero = Vec<'F'>(0, 0, -0.05);
  loop.tick(600);  // the window of the change, a whole one, and one in which that one waits
  EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.xyz[2], -0.05, 1e-9);
  test::Loop once = loop_of(Tare::start);
  once.tick(1000);
  once.force_zero = Vec<'F'>(0, 0, -0.05);
  once.tick(600);
  EXPECT_NEAR(recall<CommandState>(once.state).force_zero.xyz[2], 0.0, 1e-9);
}

// A touch that rises to the 0.1 N of a contact within 0.2 s: less than a window.
TEST(Retare, KeepsASlowTouchOutOfTheZero) {
  test::Loop loop = loop_of(Tare::window);
  loop.tick(1130);
  for (int i = 0; i < 500 && loop.out.mode != Mode::contact; ++i) {
    loop.force = Vec<'W'>(0, 0, -0.5e-3 * i);
    loop.tick();
  }
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tick(500);
  EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.xyz[2], 0.0, 1e-12);
}

}  // namespace
}  // namespace enc
