// Ball, drum and tiles as they are shipped: a tracker of 20 Hz, 50 ms late, judged by the truth.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/trial.h"

namespace enc {
namespace {

trial::TrialOptions seeded(std::uint64_t seed) {
  trial::TrialOptions options;
  options.seed = seed;
  return options;
}
models::Setup shipped(const std::string& scene) {
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", {});
}

const auto kSeeds = static_cast<std::uint64_t>(tests::thorough(2, 4));

TEST(ShippedBall, IsOneContactAHit) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    trial::Trial trial(shipped("hit_ball"), seeded(seed));
    bool touched = false;
    std::int32_t contacts = 0;
    while (trial.tick()) {
      touched = touched || trial.truth().touching;
      if (trial.outputs().contacts == contacts) continue;
      EXPECT_TRUE(touched) << "seed " << seed;
      touched = false;
      contacts = trial.outputs().contacts;
    }
    EXPECT_EQ(contacts, 3) << "100, 200 and 400 mm/s, seed " << seed;
  }
}

// What the display draws holds no machine that follows its tool.
TEST(ShippedDisplay, HoldsNoMachine) {
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(tests::thorough(6, 20)); ++seed) {
    trial::Trial trial(shipped("tennis_ball"), seeded(seed));
    while (trial.tick()) {
    }
    EXPECT_EQ(trial.result().times_held, 0) << "seed " << seed;
  }
}

// The twin with the controller, contact and admittance settings of the laboratory rig, whose set-points come
// each 10 ms.
TEST(ShippedLaboratory, RendersTheTennisBall) {
  const std::string scene = tests::source_dir() + "/models/scenes/tennis_ball.toml";
  const models::Setup there = models::load(scene, "laboratory", {"user.approach_mm_s=[50]"});
  models::Setup setup = models::load(scene, "", {"user.approach_mm_s=[50]"});
  setup.rig.manipulator = there.rig.manipulator;
  setup.rig.manipulator.driver = "sim";
  setup.rig.contact = there.rig.contact;
  setup.rig.admittance = there.rig.admittance;
  setup.twin.hexapod.delay_cycles = std::lround(there.rig.manipulator.delay * setup.rig.loop.rate);
  ASSERT_EQ(setup.twin.hexapod.delay_cycles, 14);
  trial::Trial trial(setup, seeded(1));
  double peak = 0.0;  // N
  while (trial.tick()) peak = std::max(peak, trial.truth().contact_force.e().norm());
  EXPECT_EQ(trial.result().times_held, 0);
  EXPECT_EQ(trial.result().contacts, 1);
  EXPECT_NEAR(peak, 12.05, 0.5);  // the press law at its limit of 6 mm, and the overshoot of the stop
}

// Contacts that begin though nothing has touched lately, and s of contact with nothing there.
struct Unfounded {
  int begun = 0;
  double lasting = 0.0;
};
Unfounded unfounded_of(trial::Trial& trial) {
  constexpr double kBefore = 0.05, kAfter = 0.15;  // s
  Unfounded found;
  double away = 1.0;
  std::int32_t contacts = 0;
  while (trial.tick()) {
    away = trial.truth().touching ? 0.0 : away + trial.scene().dt;
    found.begun += trial.outputs().contacts > contacts && away > kBefore ? 1 : 0;
    contacts = trial.outputs().contacts;
    if (trial.outputs().mode == Mode::contact && away > kAfter) found.lasting += trial.scene().dt;
  }
  return found;
}

// Beside the ball the prop goes along with the finger, and lags: that is no hit.
TEST(ShippedBall, IsNotHitByTheArmsOwnLag) {
  for (const char* tilt : {"45", "60"})
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      trial::Trial trial(models::load(tests::source_dir() + "/models/scenes/hit_ball.toml", "",
                                      {std::string("user.approach_tilt_deg=") + tilt}),
                         seeded(seed));
      EXPECT_EQ(unfounded_of(trial).begun, 0) << tilt << " degrees, seed " << seed;
      EXPECT_EQ(trial.outputs().contacts, 3) << tilt << " degrees, seed " << seed;
    }
}

// A ball that is hardly pushed, that is soon where it waits, and one that is too heavy to go.
TEST(ShippedBall, IsLetGoWhenNothingIsFelt) {
  for (const char* hard : {"user.approach_mm_s=[2]", "behaviour.hit_ball.interaction.travel_mm=10",
                           "behaviour.hit_ball.interaction.mass_kg=100"}) {
    trial::Trial trial(models::load(tests::source_dir() + "/models/scenes/hit_ball.toml", "", {hard}),
                       seeded(1));
    EXPECT_LT(unfounded_of(trial).lasting, 0.05) << hard;
    EXPECT_NE(trial.outputs().mode, Mode::contact) << hard;
  }
}

// The ball gets no more than the finger has put in.
TEST(ShippedBall, GainsNoEnergy) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    trial::Trial trial(shipped("hit_ball"), seeded(seed));
    double work = 0.0;
    while (trial.tick()) {
      const sim::Truth& truth = trial.truth();
      work += trial.scene().dt * dot(truth.contact_force, truth.tip_velocity);
      const Moved& ball = moved_in(trial.state())[0];
      if (ball.shift.e().isZero()) continue;
      EXPECT_LE(0.5 * 0.058 * ball.velocity.e().squaredNorm(), work) << "seed " << seed;
    }
  }
}

TEST(ShippedDrum, IsSmoothUnderTheFinger) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    trial::Trial trial(shipped("drum"), seeded(seed));
    double before = 0.0, step = 0.0, sideways = 0.0, normal = 0.0;
    while (trial.tick()) {
      const Vec<'W'>& force = trial.truth().contact_force;
      const double now = -force.xyz[2];
      step = std::max(step, std::abs(now - before));
      before = now;
      if (now < 1.0) continue;
      sideways += std::hypot(force.xyz[0], force.xyz[1]);
      normal += now;
    }
    EXPECT_LE(step, 0.4) << "N in a ms, seed " << seed;
    EXPECT_LE(sideways, 1.1 * 0.6 * normal) << "seed " << seed;
    EXPECT_EQ(trial.outputs().contacts, 1);
  }
}

// The depth of the finger leaps with each picture, and the push of a tile goes by its rate: a push that is
// gone for a tick is felt as a knock, 20 times a second.
TEST(ShippedTiles, PushWithoutGaps) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    trial::Trial trial(shipped("tiles"), seeded(seed));
    Vec3 before = Vec3::Constant(kUnset);  // N
    double most = 0.0;
    while (trial.tick()) {
      const bool contact = trial.outputs().mode == Mode::contact && trial.outputs().arm_force.finite();
      const Vec3 now = contact ? Vec3(trial.outputs().arm_force.e()) : Vec3(Vec3::Constant(kUnset));
      if (now.allFinite() && before.allFinite()) most = std::max(most, (now - before).norm());
      before = now;
    }
    EXPECT_GT(most, 0.0) << seed;
    EXPECT_LT(most, 0.6) << "N, seed " << seed;
  }
}

}  // namespace
}  // namespace enc
