// step() driven by hand: each mode and each change between them, each reason to hold, and what the loop must
// never do.
#include "core/step.h"

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/dent/dent.h"
#include "core/task/walk.h"
#include "tests/support/scenes.h"

// This test program counts its allocations.
#pragma GCC diagnostic ignored \
    "-Wmismatched-new-delete"  // inlined, free() is seen to take what our own new gave
namespace {
std::atomic<std::int64_t> allocations{0};
void* counted(std::size_t size, std::size_t alignment = 0) {
  ++allocations;
  void* p = alignment > 0 ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                          : std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace
void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
// What the library's algorithms take for their buffers.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace enc {
namespace {

using test::kBallRadius;
using test::kToolRadius;
using test::kTop;
using test::Loop;

constexpr double kSkin = 5e-6;        // m, stages.h
constexpr double kTipRadius = 0.005;  // m, RigSpec

void expect_within_limits(const Loop& loop) {
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  EXPECT_TRUE(loop.always_reachable);
}

Loop make(const SceneSpec& spec, const RigSpec& rig = test::exact_rig()) { return Loop(prepare(spec, rig)); }

// Tool above the top with its surface `gap` over it, tared, and the tip waiting under it.
void wait_under(Loop& loop, double gap = 0.010) {
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.020);  // clear of the object, for the tare
  loop.tick(500);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
}

// ---- modes
// -------------------------------------------------------------------------------------------------------------

TEST(Follow, WaitsJustInsideTheSurfaceUnderTheTool) {
  Loop loop = make(test::ball_scene());
  wait_under(loop);
  // Tip centre = surface point - (radius 5 mm + inset 0.5 mm) n.
  EXPECT_NEAR(loop.tip().xyz[2], kTop - 0.0055, 1e-9);
  EXPECT_NEAR(loop.out.gap, 0.010, 1e-12);
  // 20 degrees aside: the nearest point turns by as much, seen from the centre.
  const double a = 20.0 * M_PI / 180.0;
  const Vec3 n(std::sin(a), 0, std::cos(a));
  const Vec3 centre(0, 0, kTop - kBallRadius);
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + 0.030) * n));
  loop.tick(2000);
  EXPECT_LT((loop.tip().e() - (centre + (kBallRadius - 0.0055) * n)).norm(), 1e-9);
  EXPECT_LT(loop.worst_outside, 0.0);
  expect_within_limits(loop);
}

TEST(Follow, PausesBeyondAHundredMillimetresAndResumesAtNinety) {
  Loop loop = make(test::ball_scene());
  const auto at_gap = [&](double gap) {
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + gap);
    return loop.tick().mode;
  };
  loop.tick(300);
  EXPECT_EQ(at_gap(0.099), Mode::away);  // has not been nearer than 90 yet
  EXPECT_EQ(at_gap(0.0905), Mode::away);
  EXPECT_EQ(at_gap(0.0895), Mode::follow);
  EXPECT_EQ(at_gap(0.0995), Mode::follow);
  EXPECT_EQ(at_gap(0.1005), Mode::away);
  EXPECT_EQ(at_gap(0.0995), Mode::away);
  EXPECT_EQ(at_gap(0.0895), Mode::follow);
  // While it pauses, the tip brakes and stays.
  EXPECT_EQ(at_gap(0.2), Mode::away);
  loop.tick(200);
  const Point<'W'> waits = loop.tip();
  loop.tool_tip = Point<'W'>(0.1, 0, 0.25);
  loop.tick(100);
  EXPECT_EQ((loop.tip() - waits).norm(), 0.0);
}

TEST(Contact, BeginsByGapAtTheNearestPoint) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 1e-6);
  EXPECT_EQ(loop.tick().mode, Mode::contact);
  EXPECT_EQ(loop.out.contacts, 1);
  EXPECT_FALSE(loop.out.why & kByForce);
  EXPECT_NEAR(loop.out.first_touch.xyz[2], kTop - kTipRadius - kSkin, 1e-12);
  loop.tick(500);  // without force the tip comes up to the skin and no farther
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin, 1e-9);
  EXPECT_LT(loop.worst_outside, 0.0);
}

TEST(Contact, BeginsByForceWhereTheTrackerSaysThereIsNone) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.003);
  // The tracker errs by +0.3 mm: the tool touches while the gap says 0.3 mm.
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.3e-3);
  loop.tick(10);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  loop.force = Vec<'W'>(0, 0, -0.5);
  int until = 0;
  while (loop.out.mode == Mode::follow && until < 100) {
    loop.tick();
    ++until;
  }
  EXPECT_EQ(loop.out.mode, Mode::contact);
  // 0.1 N of 0.5 N after a 5 Hz low-pass: -ln(1 - 0.2) / (2 pi 5) = 7.1 ms.
  EXPECT_NEAR(until, 8, 1);
  EXPECT_TRUE(loop.out.why & kByForce);
  EXPECT_EQ(loop.out.contacts, 1);
}

TEST(Contact, TheSpringGivesByForceLessThreshold) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(3000);
  // (4.05 - 0.05) / 2000 = 2 mm.
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_NEAR(loop.out.deflection, 0.002, 1e-9);
  EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin - 0.002, 1e-9);
  EXPECT_NEAR(loop.out.force.xyz[2], -4.05, 1e-9);
  EXPECT_FALSE(loop.out.why & kAtLimit);
}

TEST(Contact, IsOneForEachPressUnderNoiseAndBias) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double bias : {-0.3e-3, 0.0, 0.3e-3}) {
    Loop loop = make(test::ball_scene());
    wait_under(loop, 0.010);
    const int presses = 10;
    for (int press = 0; press < presses; ++press) {
      for (int i = 0; i < 3000; ++i) {
        // True tool tip: 10 mm above the surface, down to 2 mm below within 1 s, stays 1 s, goes back.
        const double down = i < 1000 ? i / 1000.0 : i < 2000 ? 1.0 : 1.0 - (i - 2000) / 1000.0;
        const double z = kTop + kToolRadius + 0.010 - 0.012 * down;
        // The hand is a spring of 700 N/m against the tip that is where it is; only what touches presses.
        const double overlap = loop.tip().xyz[2] + kTipRadius + kToolRadius - z;
        loop.force = Vec<'W'>(0, 0, overlap > 0 ? -700.0 * overlap : 0.0) +
                     0.0125 * Vec<'W'>(normal(random), normal(random), normal(random));
        loop.tool_tip =
            Point<'W'>(2e-5 * normal(random), 2e-5 * normal(random), z + bias + 2e-5 * normal(random));
        loop.tick();
      }
      EXPECT_EQ(loop.out.contacts, press + 1) << "bias " << bias << " press " << press;
    }
    expect_within_limits(loop);
    EXPECT_LT(loop.worst_outside, 50e-6);
  }
}

TEST(Restore, GoesBackToTheBufferedPoint) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0.003, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(2000);  // the tip was still elsewhere when the gap closed: the anchor has moved to where force
                    // was felt, once
  const Point<'W'> touched = loop.out.first_touch;
  EXPECT_GT((loop.tip() - touched).norm(), 1e-3);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0.003, 0, kTop + kToolRadius + 0.020);
  bool restored = false;
  for (int i = 0; i < 3000 && loop.tick().mode != Mode::follow; ++i) {
    if (loop.out.mode == Mode::restore) {
      restored = true;
      EXPECT_EQ((loop.out.first_touch - touched).norm(), 0.0);
    }
  }
  EXPECT_TRUE(restored);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  EXPECT_LT((loop.tip() - touched).norm(),
            4e-6 + 50e-6);  // within ContactRig::restored, and at most one tick on the way inwards
  EXPECT_EQ(loop.out.contacts, 1);
}

TEST(Restore, PressedAgainOnTheWayIsANewContact) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -10.0);
  loop.tick(2000);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.005);
  for (int i = 0; i < 2000 && loop.out.mode != Mode::restore; ++i) loop.tick();
  if (loop.out.mode != Mode::restore) GTEST_FAIL() << "never restored";
  loop.force = Vec<'W'>(0, 0, -10.0);
  for (int i = 0; i < 50 && loop.out.mode == Mode::restore; ++i) loop.tick();
  // Either it was back already, and follow began the contact, or restore did: there are two now.
  loop.tick(5);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_EQ(loop.out.contacts, 2);
}

TEST(Restore, EndsAlsoWhereTheBufferedPointIsOutOfReach) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.020);
  // 100 degrees from the top the tip would have to be at z = -25 - 28 cos 80 = -30 mm; the machine ends at
  // about -25.
  const double a = 100.0 * M_PI / 180.0;
  const Vec3 centre(0, 0, kTop - kBallRadius);
  const Vec3 n(std::sin(a), 0, std::cos(a));
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.tick(200);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.020);
  loop.tick(5000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << mode_name(loop.out.mode) << ": " << why_text(loop.out.why);
}

TEST(Contact, EndsWhereTheToolIsFarAwayWhateverTheForceSays) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  // The sensor's zero has moved by 0.3 N meanwhile; no tracker errs by 80 mm.
  loop.force = Vec<'W'>(0, 0, -0.3);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.080);
  loop.tick(5000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << mode_name(loop.out.mode);
}

TEST(Contact, SlidingOffTheTipEndsItWithoutAGap) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -2.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  // 10 mm aside, more than both radii (7 mm), still below the undeformed surface, and nothing presses any
  // more.
  const double a = 10.0 / 33.0;
  loop.tool_tip = Point<'W'>(0.0335 * std::sin(a), 0, kTop - kBallRadius + 0.0335 * std::cos(a));
  loop.force = Vec<'W'>::zero();
  for (int i = 0; i < 1000 && loop.out.mode == Mode::contact; ++i) loop.tick();
  EXPECT_NE(loop.out.mode, Mode::contact);
}

// 0.1 to 20.0 mm, written as a scene does, of responses that end there or go on to 6 or 20 mm: a press that
// is held at the limit says so, and its deflection is the limit to the bit.
TEST(Contact, EveryLimitIsReached) {
  Scene scene = prepare(test::ball_scene(), test::exact_rig());
  Object& object = scene.objects[0];
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
    for (int tenths = 1; tenths <= 200; ++tenths) {
      const double limit = 1e-3 * (tenths / 10.0);
      for (const double curve : {limit, 0.006, 0.020}) {
        if (curve < limit) continue;
        ResponseSpec spec{.press = {2000.0}, .release = {1500.0}, .limit = curve};
        spec.stops = StopsSpec{{2000.0 * curve}, {0.001}, {100.0}};
        object.response = Response(spec, 100.0, reversal);
        object.limit = limit;
        const Tick tick;
        const Inputs in;
        State state;
        state.mode = Mode::contact;
        const Render task;
        Rendering now;
        now.contact.object = 0;
        now.contact.X_WN = Pose<'W', 'N'>::identity();
        for (int i = 0; i < 3; ++i) {
          stages::Walk walk(scene, tick, in);
          walk.force = Vec<'W'>(0, 0, -1000.0);
          stages::model(walk, task, state, now);
          EXPECT_TRUE(walk.why & kAtLimit) << tenths << " of " << curve;
          EXPECT_EQ(now.displacement.xyz[2], -limit) << tenths << " of " << curve;
        }
      }
    }
}

TEST(Contact, TheLimitIsHeldWhateverTheForce) {
  for (const double limit : {0.006, 0.004, 0.002}) {
    SceneSpec spec = test::ball_scene();
    spec.objects[0].limit = limit;
    Loop loop = make(spec);
    wait_under(loop, 0.001);
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
    loop.force = Vec<'W'>(0, 0, -30.0);
    double deepest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      loop.tick();
      deepest = std::max(deepest, kTop - kTipRadius - kSkin - loop.tip().xyz[2]);
    }
    EXPECT_TRUE(loop.out.why & kAtLimit);
    EXPECT_NEAR(loop.out.deflection, limit, 1e-12);
    EXPECT_LE(deepest, limit + 0.5e-3 + 1e-9);  // the inset of follow may have been deeper before
    EXPECT_NEAR(loop.tip().xyz[2], kTop - kTipRadius - kSkin - limit, 1e-9);
  }
}

// ---- force
// ------------------------------------------------------------------------------------------------------------

TEST(Force, ZeroErrorAndWeightAreTaredAway) {
  Loop loop = make(test::ball_scene());
  loop.force_zero = Vec<'F'>(0.7, -0.4, 1.3);
  loop.tool_tip = Point<'W'>(0, 0, kTop + 0.012);
  for (int i = 0; i < 199; ++i) EXPECT_TRUE(loop.tick().why & kTaring) << i;  // tare_time is 0.2 s
  loop.tick(2);
  EXPECT_FALSE(loop.out.why & kTaring);
  loop.tick(1000);
  EXPECT_LT(loop.out.force.norm(), 1e-9);
}

// [issue 3] "a rotated sensor and an oblique force give the exact displacement to 1e-9".
void oblique(Tangential tangential) {
  BehaviourSpec behaviour = test::spring();
  behaviour.tangential = tangential;
  behaviour.tangential_stiffness = 4000.0;
  RigSpec rig = test::exact_rig();
  rig.frames.H_F = {{0.004, -0.003, -0.127}, {0.3, -0.7, 2.1}};
  rig.force.tare = Tare::start;
  Loop loop = make(test::ball_scene(behaviour), rig);
  loop.force_zero = Vec<'F'>(0.7, -0.4, 1.3);
  loop.tool_tip = Point<'W'>(0.006, 0.004, 0.030);
  loop.tick(1500);
  // Touch there, where the normal is oblique in W as well.
  const Vec3 centre(0, 0, kTop - kBallRadius);
  const Vec3 n = (loop.tool_tip.e() - centre).normalized();
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.tick();
  ASSERT_EQ(loop.out.mode, Mode::contact);
  const Vec3 side = n.unitOrthogonal();
  loop.force = Vec<'W'>(Vec3(-3.05 * n + 1.2 * side));
  loop.tick(4000);
  // Normal: (3.05 - 0.05) / 2000 = 1.5 mm inwards. Sideways: 1.2 / 4000 = 0.3 mm with the force, or nothing.
  const double sideways = tangential == Tangential::spring ? 0.3e-3 : 0.0;
  const Vec3 expected = centre + (kBallRadius - kTipRadius - kSkin - 1.5e-3) * n + sideways * side;
  EXPECT_LT((loop.tip().e() - expected).norm(), 1e-9);
  EXPECT_NEAR(loop.out.force.norm(), std::hypot(3.05, 1.2), 1e-9);
  expect_within_limits(loop);
}
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForStick) { oblique(Tangential::stick); }
TEST(Force, ObliqueOnATurnedSensorGivesTheExactDisplacementForSpring) { oblique(Tangential::spring); }

TEST(Force, InertiaOfWhatMovesIsNoContact) {
  Loop loop = make(test::ball_scene());
  wait_under(loop, 0.020);
  double felt = 0.0;
  for (int i = 0; i < 3000;
       ++i) {  // the tip is driven to and fro at its limits; 0.91 kg * 0.41 m/s^2 = 0.37 N
    const double a = i % 1000 < 500 ? 0.4 : -0.4;
    loop.tool_tip = Point<'W'>(0.06 * std::sin(a), 0, kTop - kBallRadius + 0.06 * std::cos(a));
    felt = std::max(felt, loop.tick().force.norm());
  }
  EXPECT_LT(felt, 1e-6);
  EXPECT_GT(loop.worst_acceleration, 0.9);
}

// ---- hold
// -------------------------------------------------------------------------------------------------------------

SceneSpec with_display() {
  SceneSpec spec = test::ball_scene();
  spec.display.emplace();
  return spec;
}
// And a second tool in the gripper.
SceneSpec with_gripper() {
  SceneSpec spec = with_display();
  ToolSpec clamped = spec.tools.front();
  clamped.name = "clamped";
  for (Vec3& marker : clamped.markers) marker *= 1.2;
  spec.tools.push_back(clamped);
  spec.gripper.emplace().tool = "clamped";
  return spec;
}
void hold_tool(Inputs& in, const Loop& loop) {
  in.grip = {{GripPhase::closed, 0.006, 100.0, true}, loop.now(), Health::ok};
}
// A drawn surface, 20 ms old.
void draw(Inputs& in, const Loop& loop) {
  const Object& ball = loop.scene.objects[0];
  in.dent = {dent_of(ball.surface, 0, {ball.X_WO.inverse() * loop.tool_tip, kToolRadius}),
             loop.now() - Duration(20'000'000), Health::ok};
  if (in.dent.t < Time{}) in.dent.health = Health::absent;
}

void to_contact(Loop& loop) {
  wait_under(loop, 0.001);
  loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.05);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact) << why_text(loop.out.why);
}

// Calls spoil for one tick and expects hold with all of `why`; the next good tick must go on as before.
void expect_hold_and_recovery(Loop& loop, const std::function<void(Inputs&)>& spoil, std::uint32_t why,
                              const std::string& name) {
  const Mode before = loop.out.mode;
  const auto good = loop.spoil;
  loop.spoil = [&](Inputs& in) {
    if (good) good(in);
    spoil(in);
  };
  loop.tick();
  EXPECT_EQ(loop.out.mode, Mode::hold) << name << ": " << why_text(loop.out.why);
  EXPECT_EQ(loop.out.why & why, why) << name << ": " << why_text(loop.out.why);
  EXPECT_TRUE(loop.out.tip.valid()) << name;
  loop.spoil = good;
  loop.tick();
  EXPECT_EQ(loop.out.mode, before) << name << " did not recover: " << why_text(loop.out.why);
}

// The n-th leaf of Inputs that is a double is set; false when there are no more.
struct SetLeaf {
  int wanted;
  double value;
  int seen = 0;
  std::string name;
  template <class T>
  void operator()(std::string_view leaf, T& x) {
    if constexpr (std::is_same_v<T, double>) {
      if (seen++ != wanted) return;
      name = std::string(leaf);
      x = value;
    }
  }
};

TEST(Hold, WithTheRightReasonForNanInfAndAbsurdInEveryNumber) {
  Loop loop = make(with_gripper());
  loop.spoil = [&](Inputs& in) {
    draw(in, loop);
    hold_tool(in, loop);
  };
  to_contact(loop);
  int leaves = 0;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {kUnset, kInf, -kInf, 1e12, -1e12}) {
    for (int i = 0;; ++i) {
      Inputs probe;
      SetLeaf find{i, bad, 0, {}};
      fields(find, probe);
      if (find.name.empty()) break;
      const auto starts = [&](const char* text) { return find.name.rfind(text, 0) == 0; };
      if (starts("joint") || starts("arm_")) continue;  // this scene has no arm
      ++leaves;
      const std::uint32_t why = starts("X_CT")                        ? kToolInvalid
                                : starts("force") || starts("torque") ? kForceInvalid
                                : starts("dent")                      ? kDentWrong
                                : starts("grip")                      ? kToolNotHeld
                                                                      : kTipInvalid;
      expect_hold_and_recovery(
          loop,
          [&](Inputs& in) {
            SetLeaf set{i, bad, 0, {}};
            fields(set, in);
          },
          why, find.name + " = " + std::to_string(bad));
    }
  }
  EXPECT_GT(leaves, 5 * 30);
  expect_within_limits(loop);
}

TEST(Hold, WhenTheGripperLosesItsToolOrSaysNothing) {
  Loop loop = make(with_gripper());
  loop.spoil = [&](Inputs& in) {
    draw(in, loop);
    hold_tool(in, loop);
  };
  to_contact(loop);
  const auto expect = [&](const std::function<void(Stamped<GripSample>&)>& spoil, const char* name) {
    expect_hold_and_recovery(
        loop, [&](Inputs& in) { spoil(in.grip); }, kToolNotHeld, name);
    EXPECT_TRUE(loop.out.grip.closed) << name;  // in hold, too: to let go would drop the tool
  };
  expect([](auto& s) { s.value.holding = false; }, "empty");
  expect([](auto& s) { s.health = Health::fault; }, "fault");
  expect([](auto& s) { s.health = Health::absent; }, "absent");
  expect([](auto& s) { s.t = Time(Duration(1'000'000'000'000)); }, "from the future");
  expect([](auto& s) { s.t = Time::min(); }, "old");
}

TEST(Hold, ForIndicesAndStampsThatCannotBe) {
  Loop loop = make(with_display());
  loop.spoil = [&](Inputs& in) { draw(in, loop); };
  to_contact(loop);
  const Time future = Time(Duration(1'000'000'000'000));
  for (const std::int32_t bad : {-2, 1, 1 << 30, -(1 << 30)})  // -1: none recognised, no fault
    expect_hold_and_recovery(
        loop, [&](Inputs& in) { in.tool.value.tool = bad; }, kToolInvalid, "tool " + std::to_string(bad));
  for (const std::int32_t bad : {-2, 1, 1 << 30})
    expect_hold_and_recovery(
        loop, [&](Inputs& in) { in.dent.value.object = bad; }, kDentWrong, "dent " + std::to_string(bad));
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.tool.t = future; }, kToolInvalid, "tool from the future");
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.wrench.t = future; }, kForceInvalid, "force from the future");
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.tip.t = future; }, kTipInvalid, "tip from the future");
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.dent.t = future; }, kDentWrong, "dent from the future");
  // Stamps as old as a stamp can be: lost, without overflow (UBSan looks on).
  const Time oldest = Time::min();
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.wrench.t = oldest; }, kForceLost, "oldest force");
  expect_hold_and_recovery(
      loop, [&](Inputs& in) { in.tip.t = oldest; }, kTipLost, "oldest tip");
}

// A tip that brakes straight on would leave a round object: 45 mm/s over 2 * 0.6 * 0.41 m/s^2 is 4 mm along
// the tangent of a sphere of 28 mm, which is 0.3 mm outwards.
TEST(Hold, BrakingOnARoundObjectStaysInsideAndEnds) {
  for (const double inset : {5e-4, 1e-5}) {
    SceneSpec spec = test::ball_scene();
    spec.follow.inset = inset;
    Loop loop = make(spec);
    wait_under(loop, 0.001);
    const auto slide = [&](double arc) {
      const double a = arc / kBallRadius;
      const double r = kBallRadius + kToolRadius + 0.001;
      loop.tool_tip = Point<'W'>(r * std::sin(a), 0, kTop - kBallRadius + r * std::cos(a));
    };
    double arc = 0.0;
    for (int i = 0; i < 400; ++i) {
      slide(arc += 45e-6);
      loop.tick();
    }
    ASSERT_EQ(loop.out.mode, Mode::follow);
    loop.spoil = [](Inputs& in) { in.wrench.health = Health::saturated; };
    for (int i = 0; i < 300; ++i) loop.tick();
    EXPECT_EQ(loop.out.mode, Mode::hold);
    loop.spoil = nullptr;
    loop.tick();
    EXPECT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
    EXPECT_LE(loop.worst_outside, 0.0) << "inset " << inset;
    expect_within_limits(loop);
  }
}

TEST(Hold, ForHealthThatIsNotGood) {
  Loop loop = make(with_display());
  loop.spoil = [&](Inputs& in) { draw(in, loop); };
  to_contact(loop);
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.tool.health = Health::fault; }, kToolInvalid, "tool fault");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.wrench.health = Health::fault; }, kForceInvalid, "force fault");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.wrench.health = Health::absent; }, kForceLost, "force absent");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.wrench.health = Health::saturated; }, kForceSaturated, "saturated");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.wrench.health = Health::out_of_range; }, kForceSaturated, "out of range");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.tip.health = Health::fault; }, kTipInvalid, "tip fault");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.tip.health = Health::absent; }, kTipLost, "tip absent");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.dent.health = Health::fault; }, kDentWrong, "dent fault");
  expect_hold_and_recovery(
      loop, [](Inputs& in) { in.missed = 5; }, kClockLate, "late");
  loop.spoil = [&](Inputs& in) {
    draw(in, loop);
    in.missed = 4;  // fewer than late_cycles
  };
  EXPECT_EQ(loop.tick().mode, Mode::contact);
}

void drop_out(bool in_contact) {
  Loop loop = make(test::ball_scene());
  in_contact ? to_contact(loop) : wait_under(loop);
  const Mode before = loop.out.mode;
  loop.tool_seen = false;
  for (int age_ms = 1; age_ms <= 150;
       ++age_ms) {  // ages are multiples of a tick: usual up to 45, lost beyond 100
    loop.tick();
    EXPECT_EQ((loop.out.why & kToolPredicted) != 0, age_ms > 45 && age_ms <= 100) << age_ms;
    EXPECT_EQ(loop.out.mode, age_ms > 100 ? Mode::hold : before) << age_ms;
    EXPECT_EQ((loop.out.why & kToolLost) != 0, age_ms > 100) << age_ms;
  }
  loop.tool_seen = true;
  EXPECT_EQ(loop.tick().mode, before);
  expect_within_limits(loop);
}
TEST(Hold, TrackerDropOutInFollow) { drop_out(false); }
TEST(Hold, TrackerDropOutInContact) { drop_out(true); }

TEST(Hold, AToolOutOfSightWhileAwayIsSimplyAway) {
  Loop loop = make(test::ball_scene());
  loop.tool_tip = Point<'W'>(0, 0, 0.3);
  loop.tick(300);
  loop.tool_seen = false;
  loop.tick(300);
  EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
}

TEST(Hold, OverdueSurface) {
  Loop loop = make(with_display());
  loop.spoil = [&](Inputs& in) { draw(in, loop); };
  to_contact(loop);
  const Stamped<DentSample> last = loop.in.dent;
  loop.spoil = [&](Inputs& in) { in.dent = last; };
  // 20 ms old now, overdue when older than 200 ms: after 180 more ticks it is exactly 200.
  for (int i = 1; i <= 250; ++i) EXPECT_EQ((loop.tick().why & kDentOverdue) != 0, i > 180) << i;
  EXPECT_EQ(loop.out.mode, Mode::hold);
  loop.spoil = [&](Inputs& in) { draw(in, loop); };
  EXPECT_EQ(loop.tick().mode, Mode::contact);
}

TEST(Hold, TipOutsideTheSeenSurface) {
  Loop loop = make(with_display());
  loop.spoil = [&](Inputs& in) { draw(in, loop); };
  to_contact(loop);
  // The eye is shown a dent of 5 mm where the hand is at 2 mm: margin 0.8 mm + 20 ms * 50 mm/s = 1.8 mm < 3
  // mm.
  const Object& ball = loop.scene.objects[0];
  expect_hold_and_recovery(
      loop,
      [&](Inputs& in) {
        in.dent.value =
            dent_of(ball.surface, 0,
                    {ball.X_WO.inverse() * Point<'W'>(0, 0, kTop + kToolRadius - 0.005), kToolRadius});
      },
      kOutsideDent, "dent of 5 mm");
}

TEST(Hold, TipOutsideTheObject) {
  Loop loop = make(test::ball_scene());
  to_contact(loop);
  const double up = kTop - kTipRadius + 60e-6;  // tolerance 50 um
  expect_hold_and_recovery(
      loop,
      [&](Inputs& in) { in.tip.value.X_RH.xyz = (loop.scene.X_WR.inverse() * Point<'W'>(0, 0, up)).xyz; },
      kOutsideObject, "60 um out");
}

TEST(Hold, StandsStillWithinTheBrakingDistance) {
  Loop loop = make(test::ball_scene());
  wait_under(loop);
  loop.tool_tip = Point<'W'>(0.05, 0, 0.0);
  loop.tick(200);
  const Point<'W'> at = loop.tip();
  loop.spoil = [](Inputs& in) { in.missed = 100; };
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_EQ(recall<Commanded>(loop.state).command_velocity.norm(), 0.0);
  // v^2 / 2a = 0.05^2 / 0.82 = 3.05 mm.
  EXPECT_LE((loop.tip() - at).norm(), 0.00305 + 50e-6);
  expect_within_limits(loop);
}

TEST(Hold, NothingIsSaidToAMachineThatNeverAnswered) {
  Loop loop = make(test::ball_scene());
  loop.spoil = [](Inputs& in) { in.tip.health = Health::absent; };
  loop.tick(10);
  EXPECT_FALSE(loop.state.started);
  EXPECT_TRUE(loop.out.why & kTipLost);
  Outputs out;
  State state;
  step(loop.scene, loop.k, loop.in, state, out);
  EXPECT_FALSE(out.tip.valid());
}

// ---- several objects
// --------------------------------------------------------------------------------------------------

SceneSpec two_balls() {
  SceneSpec spec = test::ball_scene();
  spec.objects.push_back(spec.objects[0]);
  spec.objects[0].position.x() = -0.035;
  spec.objects[1].position.x() = 0.035;
  spec.objects[1].name = "other";
  return spec;
}

TEST(Objects, TheNearerOneTakesOverWithHysteresis) {
  Loop loop = make(two_balls());
  int switches = 0;
  std::int32_t last = -1;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> noise(-0.4e-3, 0.4e-3);
  // Along x through the middle with +-0.4 mm of noise: the difference of distances changes by less than the
  // hysteresis of 1 mm.
  for (int i = -400; i <= 400; ++i) {
    loop.tool_tip = Point<'W'>(1e-4 * i + noise(random), 0, 0.05);
    loop.tick();
    if (i > -400 && loop.out.object != last) ++switches;
    last = loop.out.object;
  }
  EXPECT_EQ(switches, 1);
  EXPECT_EQ(last, 1);
}

TEST(Objects, AContactIsNotTakenAwayByANeighbour) {
  Loop loop = make(two_balls());
  const double x = -0.02;
  loop.tool_tip = Point<'W'>(x, 0, 0.04);
  loop.tick(2500);
  const Vec3 centre(-0.035, 0, kTop - kBallRadius);
  const Vec3 n = (loop.tool_tip.e() - centre).normalized();
  loop.tool_tip = Point<'W'>(Vec3(centre + (kBallRadius + kToolRadius - 1e-4) * n));
  loop.force = Vec<'W'>(Vec3(-2.0 * n));
  loop.tick(100);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = Point<'W'>(0.035, 0, 0.04);  // the tracker jumps to the other ball, the force stays
  loop.tick(20);
  EXPECT_EQ(loop.out.object, 0);
  EXPECT_EQ(loop.out.mode, Mode::contact);
}

// ---- what the loop must not do
// ----------------------------------------------------------------------------------------

TEST(Loop, AllocatesNothingAsATestRig) {
  Loop loop(prepare(test::rig_scene(), RigSpec{}));
  Outputs out;
  std::int64_t taken = 0;
  for (int i = 0; i < 9000; ++i) {  // to the rest after the first push
    State copy = loop.state;
    loop.tick();
    const Inputs in = loop.in;
    const std::int64_t before = allocations;
    step(loop.scene, loop.k, in, copy, out);
    taken += allocations - before;
  }
  EXPECT_EQ(taken, 0);
  EXPECT_EQ(out.contacts, 1);
}

TEST(Loop, AllocatesNothing) {
  Loop loop = make(with_display());
  Inputs in;
  Outputs out;
  std::int64_t taken = 0;
  std::int64_t modes = 0;
  loop.spoil = [&](Inputs& i) { draw(i, loop); };
  for (int i = 0; i < 4000; ++i) {
    loop.tool_tip = Point<'W'>(0, 0, kTop + kToolRadius + 0.02 * std::cos(i * 2e-3));
    loop.force = Vec<'W'>(0, 0, std::min(0.0, 3 * std::cos(i * 2e-3)));
    if (i % 500 == 499) loop.tool_seen = !loop.tool_seen;
    State copy = loop.state;
    loop.tick();
    in = loop.in;
    const std::int64_t before = allocations;
    step(loop.scene, loop.k, in, copy, out);
    taken += allocations - before;
    modes |= 1 << static_cast<int>(out.mode);
  }
  EXPECT_EQ(taken, 0);
  EXPECT_GT(allocations.load(), 0);  // the counter counts
  EXPECT_EQ(modes & (1 << static_cast<int>(Mode::contact)), 1 << static_cast<int>(Mode::contact));
}

}  // namespace
}  // namespace enc
