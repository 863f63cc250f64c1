// What the person of a session wants: reaches out of submovements, places that can be pressed, one change of
// the tool.
#include "sim/hand/session_plan.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/control/scene/press_check.h"
#include "sim/hand/user.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using sim::HandPlan;
using sim::Phase;
using sim::SessionPlan;

// The shipped scene, with a plan on it.
struct Session {
  explicit Session(const std::vector<std::string>& set = {})
      : setup(models::load(scene_file("session"), "sim", set)),
        scene(trial::prepare_setup(setup)),
        plan(setup.scene, scene, setup.twin.hand) {}
  [[nodiscard]] const SessionSpec& spec() const { return *setup.scene.user->session; }

  models::Setup setup;
  Scene scene;
  SessionPlan plan;
};

// Calls look(time, plan, state) on each millisecond of a session.
template <class Look>
void walk(const Session& session, std::uint64_t seed, const Look& look) {
  SessionPlan::State state = session.plan.begin(seed);
  for (int i = 0; !state.finished; ++i) {
    const double t = 0.001 * i;
    session.plan.advance(t, state);
    look(t, session.plan.at(t, state), state);
  }
}

bool in_range(double x, const std::vector<double>& range) {
  return x >= range[0] * (1.0 - 1e-9) && x <= range[1] * (1.0 + 1e-9);
}

TEST(Submovement, IsAMinimumJerkFromRestToRest) {
  const sim::Submovement move{0.5, 0.4, Vec<'W'>(0.03, 0, 0.04)};
  EXPECT_DOUBLE_EQ(move.peak_speed(), 1.875 * 0.05 / 0.4);
  HandPlan before, half, after;
  move.add_to(before, 0.4);
  move.add_to(half, 0.7);
  move.add_to(after, 0.9);
  EXPECT_EQ(before.position, Vec3(0, 0, 0));
  EXPECT_NEAR(half.position.norm(), 0.025, 1e-12);
  EXPECT_NEAR(half.velocity.norm(), move.peak_speed(), 1e-12);
  EXPECT_NEAR((after.position - Vec3(0.03, 0, 0.04)).norm(), 0.0, 1e-15);
  EXPECT_EQ(after.velocity.norm(), 0.0);
}

TEST(SessionPlan, SubmovementsSumToTheWay) {
  const Session session;
  SessionPlan::State state = session.plan.begin(1);
  int reaches = 0;
  for (int i = 0; !state.finished; ++i) {
    const Phase before = state.phase;
    session.plan.advance(0.001 * i, state);
    if (before == Phase::approach || state.phase != Phase::approach) continue;
    ++reaches;
    const SessionPlan::Press& press = state.press;
    const Vec3 end = press.start.e() + press.primary.way.e() + press.second.way.e();
    const Vec3 wanted =
        press.aborted ? Vec3(press.start.e()) : Vec3((press.touch - press.reached * press.at.normal).e());
    EXPECT_LT((end - wanted).norm(), 1e-12);
    EXPECT_GE(press.aborted ? 0.0 : press.reached, 0.0);
  }
  EXPECT_GT(reaches, 15);
}

TEST(SessionPlan, DrawsStayWithinTheirLimits) {
  const Session session;
  const SessionSpec& spec = session.spec();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::int32_t last = -1;
    walk(session, seed, [&](double t, const HandPlan&, const SessionPlan::State& state) {
      EXPECT_LE(t, spec.duration);
      if (state.count == last || state.finished) return;
      last = state.count;
      const SessionPlan::Press& p = state.press;
      const Vec3 away = (p.start - p.touch).e();
      EXPECT_TRUE(in_range(away.norm(), spec.reach));
      EXPECT_TRUE(
          in_range(std::acos(std::min(1.0, p.at.normal.e().dot(away.normalized()))) + 1e-9, spec.tilt));
      EXPECT_TRUE(in_range(p.primary.peak_speed(), spec.peak_speed));
      EXPECT_TRUE(in_range(p.touch_speed, spec.touch_speed));
      EXPECT_TRUE(in_range(p.hold_time, spec.hold) || p.aborted);
      EXPECT_LE(std::acos(p.at.normal.xyz[2]), spec.polar_most + 1e-9);
      EXPECT_TRUE(carried_to(session.scene, p.at, session.scene.objects.front().limit));
      EXPECT_EQ(in_the_way(session.scene, p.at.normal, session.scene.tools[state.held == 1 ? 1 : 0]),
                Obstacle::none);
      if (!p.aborted) {
        EXPECT_TRUE(in_range(p.depth, spec.depth)) << p.depth;
      }
    });
  }
}

TEST(SessionPlan, AReachThatTurnsBackNeverTouches) {
  const Session session({"truth.hand.aborted=1"});
  const Point<'W'> centre(session.setup.scene.objects.front().position);
  const double radius = session.setup.scene.objects.front().radius;
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    walk(session, seed, [&](double, const HandPlan& plan, const SessionPlan::State& state) {
      EXPECT_TRUE(state.press.aborted);
      EXPECT_NE(state.phase, Phase::press);
      if (state.held < 0) return;
      const double tip = session.scene.tools[static_cast<std::size_t>(session.plan.tool(state))].tip.radius;
      EXPECT_GT((plan.position - centre.e()).norm(), radius + tip + 0.004);
    });
}

TEST(SessionPlan, PositionAndVelocityAreContinuous) {
  const Session session;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Vec3 before = Vec3::Constant(kUnset);
    walk(session, seed, [&](double t, const HandPlan& plan, const SessionPlan::State&) {
      if (before.allFinite()) {
        EXPECT_LT((plan.position - before).norm(), 0.7e-3) << t;  // no faster than 0.7 m/s
      }
      before = plan.position;
    });
  }
}

TEST(SessionPlan, TheToolIsChangedOnceInTheMiddle) {
  const Session session;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<std::int32_t> tools;
    double begun = kUnset;
    walk(session, seed, [&](double t, const HandPlan& plan, const SessionPlan::State& state) {
      const std::int32_t tool = session.plan.tool(state);
      if (tools.empty() || tools.back() != tool) tools.push_back(tool);
      if (state.phase == Phase::change && std::isnan(begun)) begun = t;
      if (tool < 0) {  // on the tray
        EXPECT_GT((plan.position - session.setup.scene.objects.front().position).norm(), 0.133);
      }
    });
    EXPECT_EQ(tools, (std::vector<std::int32_t>{0, -1, 1}));
    EXPECT_GE(begun, 0.4 * session.spec().duration);
    EXPECT_LE(begun, 0.6 * session.spec().duration + 15.0);  // the press at that time is ended first
  }
}

TEST(SessionPlan, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Session session;
  const SessionPlan::Press a = session.plan.begin(3).press, b = session.plan.begin(3).press,
                           c = session.plan.begin(4).press;
  EXPECT_EQ(a.start.xyz, b.start.xyz);
  EXPECT_EQ(a.primary.way.xyz, b.primary.way.xyz);
  EXPECT_NE(a.start.xyz, c.start.xyz);
}

TEST(SessionHand, TremblesBetween8And12HertzOnly) {
  const Session session;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const sim::User user(session.setup.scene, session.scene, session.setup.twin.hand, seed);
    std::set<double> rates;
    for (const double rate : user.state().band_rate) {
      EXPECT_GE(rate, 2.0 * std::numbers::pi * 8.0);
      EXPECT_LE(rate, 2.0 * std::numbers::pi * 12.2);
      rates.insert(rate);
    }
    EXPECT_EQ(rates.size(), user.state().band_rate.size());
  }
}

}  // namespace
}  // namespace enc::test
