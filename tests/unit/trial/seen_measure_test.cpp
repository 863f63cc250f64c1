// Presses tell that the tracker, or the camera, does not stand where it was registered.
#include "trial/measure/seen_measure.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc::trial {
namespace {

using Set = std::vector<std::string>;

models::Setup setup_of(const std::string& scene, const Set& set = {}) {
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", set);
}

// Two presses of 6 mm with little between them.
SeenMeasure seen(const std::string& scene, const Set& more, std::uint64_t seed = 1) {
  Set set{"user.approach_mm_s=[100, 100]",
          "user.approach_from_mm=125",
          "user.depth_mm=6",
          "user.press_s=1",
          "user.hold_s=0.5",
          "user.release_s=1",
          "user.rest_s=0.3"};
  set.insert(set.end(), more.begin(), more.end());
  SeenMeasure measure;
  TrialOptions options;
  options.seed = seed;
  const sim::Truth none;  // as of real devices
  options.watch = [&](const Glance& glance) {
    measure.see({glance.scene, glance.tick, none, glance.in, glance.out, false});
  };
  static_cast<void>(Trial(setup_of(scene, set), options).run());
  return measure;
}

Vec3 moved(const SeenMeasure& measure) { return -measure.moved().shift; }

TEST(SeenMeasure, AFingerIsSeenWhereItPushesTheProp) {
  for (const char* scene : {"wall", "button"}) {
    const SeenMeasure measure = seen(scene, {});
    ASSERT_EQ(measure.presses().size(), 2U) << scene;
    EXPECT_LT(measure.shift().shift.norm(), 0.3e-3) << scene;
    EXPECT_EQ(measure.moved().presses, 0U) << scene;
  }
}

// Too high a finger pushes before the core believes it, too low a one lies on the prop.
TEST(SeenMeasure, ACameraThatHasMovedIsFoundWithItsWay) {
  for (const double mm : {5.0, -5.0, 3.0, -3.0}) {
    const SeenMeasure measure = seen("wall", {"truth.tracker.bias_mm=[0, 0, " + std::to_string(-mm) + "]"});
    ASSERT_EQ(measure.moved().presses, 2U) << mm;
    EXPECT_NEAR(moved(measure).z() * 1e3, mm, 0.6);
    EXPECT_NEAR(moved(measure).head<2>().norm(), 0.0, 1e-6) << "what no press tells is not told";
    EXPECT_EQ(measure.moved().ways, 1);
  }
}

// As it is registered, by pose and not by bias: the rig believes that it stands 5 mm lower.
TEST(SeenMeasure, ARegistrationThatIsOffIsFound) {
  const models::Setup shipped = setup_of("wall");
  Vec3 off = shipped.rig.frames.W_C.position * 1e3;
  off.z() -= 5.0;
  const std::string set = "rig.frames.W_C.position_mm=[" + std::to_string(off.x()) + ", " +
                          std::to_string(off.y()) + ", " + std::to_string(off.z()) + "]";
  const SeenMeasure measure = seen("wall", {set});
  ASSERT_EQ(measure.moved().presses, 2U);
  EXPECT_NEAR(moved(measure).z() * 1e3, 5.0, 0.6);
}

// Aside of the normal nothing is told, and nothing wrong either.
TEST(SeenMeasure, AcrossTheNormalAPressTellsNothing) {
  const SeenMeasure measure = seen("wall", {"truth.tracker.bias_mm=[5, 0, 0]"});
  ASSERT_EQ(measure.presses().size(), 2U);
  EXPECT_EQ(measure.moved().presses, 0U);
}

TEST(SeenMeasure, OnePressIsNoEvidence) {
  const SeenMeasure measure = seen("wall", {"user.approach_mm_s=[100]", "truth.tracker.bias_mm=[0, 0, 5]"});
  ASSERT_EQ(measure.presses().size(), 1U);
  EXPECT_EQ(measure.moved().presses, 0U);
}

TEST(SeenMeasureLong, NeverInVainAndAlwaysFoundOverSeeds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(seen("wall", {}, seed).moved().presses, 0U) << seed;
    EXPECT_EQ(seen("button", {}, seed).moved().presses, 0U) << seed;
    for (const char* bias : {"5", "-5"})
      EXPECT_GT(
          seen("wall", {std::string("truth.tracker.bias_mm=[0, 0, ") + bias + "]"}, seed).moved().presses, 0U)
          << seed << " " << bias;
  }
}

}  // namespace
}  // namespace enc::trial
