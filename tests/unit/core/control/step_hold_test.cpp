// step() driven by hand: each reason to hold, and the end of each hold.
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/control/step.h"
#include "core/shape/deformation/dent.h"
#include "tests/support/by_hand.h"

namespace enc {
namespace {

using test::draw, test::expect_within_limits, test::kBallRadius, test::kTipRadius, test::kToolRadius,
    test::kTop, test::Loop, test::make, test::to_contact, test::wait_under, test::with_display;

// A display, and a second tool in the gripper.
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

// Call `spoil` for one tick and expect hold with all of `why`; the next good tick must continue as before.
void expect_hold(Loop& loop, std::uint32_t why, const std::string& name,
                 const std::function<void(Inputs&)>& spoil) {
  const Mode before = loop.out.mode;
  const auto good = loop.spoil;
  loop.spoil = [&](Inputs& in) {
    if (good) good(in);
    spoil(in);
  };
  loop.tick();
  EXPECT_EQ(loop.out.mode, Mode::hold) << name << ": " << why_text(loop.out.why);
  EXPECT_EQ(loop.out.why & why, why) << name << ": " << why_text(loop.out.why);
  EXPECT_TRUE(loop.out.manipulator.tip.valid()) << name;
  loop.spoil = good;
  loop.tick();
  EXPECT_EQ(loop.out.mode, before) << name << " did not recover: " << why_text(loop.out.why);
}

// Sets the n-th double among the leaves of Inputs; false if there are no more.
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
    in.tool.value.along = in.tool.value.across = 0.1e-3;  // a tracker that reports no noise is valid
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
      const std::uint32_t why = starts("X_CT") || starts("noise")     ? kToolInvalid
                                : starts("force") || starts("torque") ? kForceInvalid
                                : starts("dent")                      ? kDentWrong
                                : starts("grip")                      ? kToolNotHeld
                                                                      : kTipInvalid;
      expect_hold(loop, why, find.name + " = " + std::to_string(bad), [&](Inputs& in) {
        SetLeaf set{i, bad, 0, {}};
        fields(set, in);
      });
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
  const auto expect = [&](const std::function<void(Measurement<GripSample>&)>& spoil, const char* name) {
    expect_hold(loop, kToolNotHeld, name, [&](Inputs& in) { spoil(in.grip); });
    EXPECT_TRUE(loop.out.manipulator.grip.closed)
        << name;  // also in hold: an open gripper would drop the tool
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
    expect_hold(loop, kToolInvalid, "tool " + std::to_string(bad),
                [&](Inputs& in) { in.tool.value.tool = bad; });
  for (const std::int32_t bad : {-2, 1, 1 << 30})
    expect_hold(loop, kDentWrong, "dent " + std::to_string(bad),
                [&](Inputs& in) { in.dent.value.object = bad; });
  expect_hold(loop, kToolInvalid, "tool from the future", [&](Inputs& in) { in.tool.t = future; });
  expect_hold(loop, kForceInvalid, "force from the future", [&](Inputs& in) { in.wrench.t = future; });
  expect_hold(loop, kTipInvalid, "tip from the future", [&](Inputs& in) { in.tip.t = future; });
  expect_hold(loop, kDentWrong, "dent from the future", [&](Inputs& in) { in.dent.t = future; });
  // Stamps as old as a stamp can be count as lost, without overflow (UBSan checks).
  const Time oldest = Time::min();
  expect_hold(loop, kForceLost, "oldest force", [&](Inputs& in) { in.wrench.t = oldest; });
  expect_hold(loop, kTipLost, "oldest tip", [&](Inputs& in) { in.tip.t = oldest; });
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
      const double a = arc / kBallRadius, r = kBallRadius + kToolRadius + 0.001;
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
  expect_hold(loop, kTrackerFault, "tool fault", [](Inputs& in) { in.tool.health = Health::fault; });
  expect_hold(loop, kForceInvalid, "force fault", [](Inputs& in) { in.wrench.health = Health::fault; });
  expect_hold(loop, kForceLost, "force absent", [](Inputs& in) { in.wrench.health = Health::absent; });
  expect_hold(loop, kForceSaturated, "saturated", [](Inputs& in) { in.wrench.health = Health::saturated; });
  expect_hold(loop, kForceSaturated, "out of range",
              [](Inputs& in) { in.wrench.health = Health::out_of_range; });
  expect_hold(loop, kTipInvalid, "tip fault", [](Inputs& in) { in.tip.health = Health::fault; });
  expect_hold(loop, kTipLost, "tip absent", [](Inputs& in) { in.tip.health = Health::absent; });
  expect_hold(loop, kDentWrong, "dent fault", [](Inputs& in) { in.dent.health = Health::fault; });
  expect_hold(loop, kClockLate, "late", [](Inputs& in) { in.missed = 5; });
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
// Tool data of 100 Hz: the second missing pose may be late by half a period. Without a rate only the age
// counts.
TEST(Hold, APoseIsOldOnceTheNextTwoAreMissing) {
  for (const double rate : {100.0, kUnset}) {
    RigSpec rig;
    rig.tracker.rate = rate;
    Loop loop(prepare(test::ball_scene(), rig));
    wait_under(loop);
    loop.tool_seen = false;
    for (int age_ms = 1; age_ms <= 100; ++age_ms) {
      loop.tick();
      EXPECT_EQ((loop.out.why & kToolPredicted) != 0, age_ms > (rate > 0.0 ? 25 : 45))
          << rate << " " << age_ms;
    }
    loop.tool_seen = true;
    loop.tick();
    EXPECT_EQ(loop.out.why & kToolPredicted, 0U);
  }
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
  const Measurement<DentSample> last = loop.in.dent;
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
  // The display shows a dent of 5 mm while the hand is at 2 mm: margin 0.8 mm + 20 ms * 50 mm/s = 1.8 mm < 3
  // mm.
  const Object& ball = loop.scene.objects[0];
  expect_hold(loop, kOutsideDent, "dent of 5 mm", [&](Inputs& in) {
    in.dent.value = dent_of(
        ball.surface, 0, {ball.X_WO.inverse() * Point<'W'>(0, 0, kTop + kToolRadius - 0.005), kToolRadius});
  });
}

TEST(Hold, TipOutsideTheObject) {
  Loop loop = make(test::ball_scene());
  to_contact(loop);
  const double up = kTop - kTipRadius + 60e-6;  // tolerance 50 um
  expect_hold(loop, kOutsideObject, "60 um out", [&](Inputs& in) {
    in.tip.value.X_RH.xyz = (loop.scene.X_WR.inverse() * Point<'W'>(0, 0, up)).xyz;
  });
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
  EXPECT_EQ(recall<CommandState>(loop.state).command_velocity.norm(), 0.0);
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
  EXPECT_FALSE(out.manipulator.tip.valid());
}

}  // namespace
}  // namespace enc
