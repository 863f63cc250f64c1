// The plans of a simulated hand.
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/scene/press_check.h"
#include "sim/hand/hand_plan.h"
#include "sim/hand/session_plan.h"
#include "sim/hand/user.h"
#include "tests/support/twin.h"
#include "trial/trial.h"

namespace enc::sim {
namespace {

using test::scene_file;

// The plan of a session's simulated person: reaches out of submovements, places that can be pressed, one
// change of the tool.

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
    EXPECT_LE(begun, 0.6 * session.spec().duration + 15.0);  // the press at that time ends first
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

// The plan of a simulated person who reaches for objects: from far away, any place of any object, at a given
// rate.

struct Reaching {
  explicit Reaching(const std::vector<std::string>& set = {})
      : Reaching(models::load(scene_file("reaching"), "", set)) {}
  explicit Reaching(models::Setup made)
      : setup(std::move(made)),
        scene(trial::prepare_setup(setup)),
        plan(setup.scene, scene, setup.twin.hand) {}
  [[nodiscard]] const ReachesSpec& spec() const { return *setup.scene.user->reaches; }

  models::Setup setup;
  Scene scene;
  SessionPlan plan;
};

// Calls look(press) once for each reach.
template <class Look>
void each(const Reaching& reaching, std::uint64_t seed, const Look& look) {
  SessionPlan::State state = reaching.plan.begin(seed);
  look(state.press);
  std::int32_t count = state.count;
  for (int i = 0; !state.finished; ++i) {
    reaching.plan.advance(0.001 * i, state);
    if (state.count == count || state.finished) continue;
    count = state.count;
    look(state.press);
  }
}

bool within(double x, const std::vector<double>& range) {
  return x >= range[0] * (1.0 - 1e-9) && x <= range[1] * (1.0 + 1e-9);
}

TEST(ReachesPlan, ThereAreAsManyAsWanted) {
  const Reaching reaching({"user.reaches.count=7"});
  int count = 0;
  each(reaching, 1, [&](const SessionPlan::Press&) { ++count; });
  EXPECT_EQ(count, 7);
}

TEST(ReachesPlan, PlacesAreOnTheObjectsAndTheNormalPointsOut) {
  const Reaching reaching({"user.reaches.count=60"});
  std::set<std::int32_t> objects;
  each(reaching, 2, [&](const SessionPlan::Press& press) {
    objects.insert(press.object);
    const Object& object = reaching.scene.objects.at(static_cast<std::size_t>(press.object));
    const Point<'W'> outside = press.at.point + 1e-3 * press.at.normal;
    const SurfacePoint at = object.surface.nearest(object.X_WO.inverse() * outside);
    EXPECT_NEAR(at.distance, 1e-3, 1e-12);
    EXPECT_LT((object.X_WO * at.point - press.at.point).norm(), 1e-12);
    if (press.object == 0) {
      EXPECT_LE(std::abs(press.at.point.xyz[0]), reaching.spec().spread);
      EXPECT_LE(std::abs(press.at.point.xyz[1]), reaching.spec().spread);
    } else {
      EXPECT_GE(press.at.normal.xyz[2], std::cos(reaching.spec().polar_most));
    }
  });
  EXPECT_EQ(objects, (std::set<std::int32_t>{0, 1, 2}));
}

TEST(ReachesPlan, PlacesOfAButtonAreOnItsFace) {
  models::Setup setup = models::load(scene_file("keypad"), "", {});
  setup.scene.user->kind = UserKind::reaches;
  setup.scene.user->reaches.emplace();
  const Reaching reaching(std::move(setup));
  each(reaching, 3, [&](const SessionPlan::Press& press) {
    const Object& key = reaching.scene.objects.at(static_cast<std::size_t>(press.object));
    const Vec3 beside = (press.at.point - key.X_WO.origin()).e();
    EXPECT_LE(std::abs(beside.x()), 7.5e-3);
    EXPECT_LE(std::abs(beside.y()), 7.5e-3);
    EXPECT_NEAR(beside.z(), 0.0, 1e-15);
  });
}

TEST(ReachesPlan, BeginFarFromEveryObject) {
  const Reaching reaching({"user.reaches.count=60"});
  each(reaching, 4, [&](const SessionPlan::Press& press) {
    for (const Object& object : reaching.scene.objects)
      EXPECT_GT(object.surface.nearest(object.X_WO.inverse() * press.start).distance - 8e-3,
                reaching.scene.follow.pause);
  });
}

TEST(ReachesPlan, DrawsStayWithinTheirLimits) {
  const Reaching reaching({"user.reaches.count=60"});
  const ReachesSpec& spec = reaching.spec();
  each(reaching, 5, [&](const SessionPlan::Press& press) {
    const Vec3 away = (press.start - press.touch).e();
    EXPECT_TRUE(within(away.norm(), spec.reach));
    EXPECT_LE(std::acos(press.at.normal.e().dot(away) / away.norm()), spec.tilt[1] + 1e-9);
    EXPECT_TRUE(within(press.primary.peak_speed(), spec.peak_speed));
    EXPECT_TRUE(within(press.touch_speed, spec.touch_speed));
    EXPECT_TRUE(within(press.rest, spec.rest) || press.rest == 0.8);  // at least 0.8 s before the first
    EXPECT_GE(press.depth, std::min(spec.depth[0], press.reached));
  });
}

TEST(ReachesPlan, DurationIsWhatItTakes) {
  const Reaching reaching({"user.reaches.count=5"});
  const SessionPlan::State begun = reaching.plan.begin(6);
  SessionPlan::State state = begun;
  double t = 0.0;
  while (!state.finished) reaching.plan.advance(t += 0.001, state);
  EXPECT_GE(reaching.plan.duration(begun), t - 0.001);
  EXPECT_LE(reaching.plan.duration(begun), t + 2.0);
}

TEST(ReachesPlan, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Reaching reaching;
  const SessionPlan::Press a = reaching.plan.begin(3).press, b = reaching.plan.begin(3).press,
                           c = reaching.plan.begin(4).press;
  EXPECT_EQ(a.touch.xyz, b.touch.xyz);
  EXPECT_EQ(a.primary.time, b.primary.time);
  EXPECT_NE(a.touch.xyz, c.touch.xyz);
}

TEST(ReachesPlan, RefusesAStartThatIsNeverFar) {
  const Reaching reaching({"user.reaches.tilt_deg=[60,60]", "user.reaches.reach_mm=[125,130]"});
  EXPECT_THROW((void)reaching.plan.begin(1), Error);
}

// A whole loop with an arm and a finger that is seen live: each reach is one contact, of the intended object,
// and the arm stands in between.
TEST(ReachesWorld, EachReachIsOneContact) {
  const models::Setup setup = models::load(
      scene_file("reaching"), "",
      {"user.reaches.count=3", "truth.hand.aborted=0", "truth.tracker.rate_hz=1000",
       "truth.tracker.latency_ms=1", "truth.tracker.noise_mm=[0,0,0]", "truth.tracker.marker_noise_mm=0",
       "rig.tracker.measurement_noise_mm=0.01", "rig.tracker.acceleration_noise_m_s2_per_sqrt_hz=1"});
  trial::TrialOptions options;
  int touched = 0, right = 0;
  bool before = false;
  options.watch = [&](const trial::Glance& glance) {
    if (glance.out.mode == Mode::contact && !before) {
      ++touched;
      right += glance.out.object == glance.truth.aim ? 1 : 0;
    }
    before = glance.out.mode == Mode::contact;
  };
  trial::Trial trial(setup, options);
  const trial::TrialResult result = trial.run();
  EXPECT_EQ(result.contacts, 3);
  EXPECT_EQ(touched, 3);
  EXPECT_EQ(right, 3);
  EXPECT_LT(result.diverged_at, 0);
}

// A steered hand is as fast and as strong as a person's, and pushes along the normal.

constexpr double kStep = 1e-3;  // s

TEST(SteeredPlan, GoesWhereItIsToldAsFastAsAPerson) {
  SteeredPlan plan;
  plan.steer({0.3, 0, 0}, {0, 0, 0});
  double fastest = 0.0, farthest = 0.0, quickest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const HandPlan now = plan.advance(kStep, plan.at, false, 250.0, 0.05);
    fastest = std::max(fastest, now.velocity.norm());
    quickest = std::max(quickest, now.acceleration.norm());
    farthest = std::max(farthest, now.position.x());
  }
  EXPECT_NEAR(plan.at.xyz[0], 0.3, 1e-6);
  EXPECT_GT(fastest, 0.45);
  EXPECT_LE(fastest, SteeredPlan::kFastest + 1e-9);
  EXPECT_LE(quickest, SteeredPlan::kQuickest + 1e-9);
  EXPECT_LT(farthest, 0.3 + 1e-3) << "it does not overshoot";
}

// The tip stands on a surface; the mouse moves into it, slightly aside.
Vec3 pushed(const Vec3& way) {
  SteeredPlan plan;
  plan.steer({0, 0, 0}, {0, 0, 0});
  plan.touch({0, 0, 0}, {0, 0, 1});
  plan.steer(Point<'W'>(way), {0, 0, 0});
  HandPlan now;
  for (int i = 0; i < 1000; ++i) now = plan.advance(kStep, {0, 0, 0}, true, 250.0, 0.05);
  return now.position;
}

TEST(SteeredPlan, PushesAlongTheNormalUntilItIsDrawnClearlyAside) {
  const Vec3 straight = pushed({0.003, 0, -0.004});
  EXPECT_NEAR(straight.x(), 0.0, 1e-9);
  EXPECT_LT(straight.z(), -0.04) << "the place is not reached, so it is pushed harder for";
  EXPECT_GE(straight.z(), -0.004 - SteeredPlan::kStrongest / 250.0 - 1e-9);
  const Vec3 aside = pushed({0.02, 0, -0.004});
  EXPECT_GT(aside.x(), 0.015);
}

TEST(SteeredPlan, LeavesTheSurface) {
  SteeredPlan plan;
  plan.steer({0, 0, 0}, {0, 0, 0});
  plan.touch({0, 0, 0}, {0, 0, 1});
  (void)plan.advance(kStep, {0, 0, 0.0019}, false, 250.0, 0.05);
  EXPECT_TRUE(plan.touched);
  (void)plan.advance(kStep, {0, 0, 0.0021}, false, 250.0, 0.05);
  EXPECT_FALSE(plan.touched);
  // A tip that slid off a ball is in free air below the plane of its touch, too.
  plan.touch({0, 0, 0}, {0, 0, 1});
  for (int i = 0; i < 60; ++i) (void)plan.advance(kStep, {0.1, 0, -0.02}, false, 250.0, 0.05);
  EXPECT_FALSE(plan.touched);
}

}  // namespace
}  // namespace enc::sim
