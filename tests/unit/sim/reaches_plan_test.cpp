// What a person wants who reaches for what is there: from far away, for any place of any object, so many
// times.
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sim/hand/session_plan.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using sim::Phase;
using sim::SessionPlan;

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
    const Nearest at = object.surface.nearest(object.X_WO.inverse() * outside);
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
    EXPECT_TRUE(within(press.rest, spec.rest) || press.rest == 0.8);  // before the first at least 0.8 s
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

// With the arm in the loop and a finger that is seen live: each reach is one contact, of the object that was
// meant, and in between the arm stands.
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

}  // namespace
}  // namespace enc::test
