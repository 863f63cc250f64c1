// What a run is judged by where there is no truth, and what a hand's strength is.
#include "trial/measure/touch_measure.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "models/files.h"
#include "tests/support/built.h"

namespace enc::trial {
namespace {

models::Setup touched(const std::string& scene, const std::vector<std::string>& set = {}) {
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", set);
}

// As of a real arm and a real finger: the measure is not shown what is true.
std::size_t empty_contacts(const models::Setup& setup, bool withheld = false) {
  TouchMeasure touches;
  TrialOptions options;
  const sim::Truth none;
  options.watch = [&](const Glance& glance) {
    Inputs in = glance.in;
    in.withheld = withheld;
    touches.see({glance.scene, glance.tick, none, in, glance.out, false});
  };
  static_cast<void>(Trial(setup, options).run());
  EXPECT_TRUE(touches.plan().tried().empty());
  return touches.empty().size();
}

TEST(TouchMeasure, AnArmKnowsWithoutATruthThatNothingPushedItsProp) {
  const models::Setup beside = touched("wall", {"truth.tracker.bias_mm=[60,0,0]"});
  EXPECT_EQ(empty_contacts(beside), 3U);
  EXPECT_EQ(empty_contacts(beside, true), 0U) << "a machine that is told nothing does not push back";
  for (const char* name : {"wall", "drum", "tiles", "button", "keypad", "room", "hit_ball", "reaching"})
    EXPECT_EQ(empty_contacts(touched(name)), 0U) << name;
}

// A hand breaks through a wall that no motor holds and strikes the arm's stop. Then its mass rings on its
// grip about what it pushes with: by the speed of the impact times sqrt(k m).
TEST(TouchMeasure, AHandPushesHarderThanItsStrengthOnlyByTheImpactOfItsMass) {
  constexpr double kAverage = 1.0;  // s
  const models::Setup setup = touched("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=1000"});
  const sim::HandTruth& hand = setup.twin.hand;
  TrialOptions options;
  double most = 0.0, mean = 0.0, lasting = 0.0, speed = 0.0;
  options.watch = [&](const Glance& glance) {
    const double force = glance.truth.contact_force.norm();
    most = std::max(most, force);
    mean += glance.scene.dt / kAverage * (force - mean);
    lasting = std::max(lasting, mean);
    speed = std::max(speed, glance.truth.tool_velocity.norm());
  };
  static_cast<void>(Trial(setup, options).run());
  EXPECT_GT(lasting, 0.7 * hand.strength);
  EXPECT_LT(lasting, 1.05 * hand.strength);
  EXPECT_GT(most, hand.strength);
  EXPECT_LT(most, hand.strength + speed * std::sqrt(hand.grip_stiffness * hand.mass));
}

}  // namespace
}  // namespace enc::trial
