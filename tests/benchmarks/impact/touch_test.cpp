// The first touch, observed step by step, and the contact law that judges it.
#include "benchmarks/impact/touch.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/built.h"

namespace enc::bench::impact {
namespace {

models::Setup session() {
  return models::load(tests::source_dir() + "/models/scenes/session.toml", {},
                      {"truth.hand.drift_mm=0", "truth.solver.tolerance=1e-12"});
}
Law law(double stiffness, double friction) {
  return {stiffness, 1.0, 0.0, 0.6 * std::sqrt(stiffness * 0.05), friction};
}

TEST(FirstTouch, IsFoundAndJudgedAlikeByTheLawOfItsOwn) {
  const models::Setup setup = session();
  const TouchRecord watched = watch_touch(setup, 1);
  EXPECT_EQ(watched.failure, "");
  ASSERT_FALSE(std::isnan(watched.touch.at));
  EXPECT_GT(watched.touch.speed, 5e-3);
  EXPECT_GE(watched.touch.peak, watched.touch.sampled);
  ASSERT_GT(watched.steps.size(), 100U);
  const FirstTouch reference = refer(setup, 1, watched, law(1e5, 0.6), 5e-6);
  EXPECT_NEAR(reference.at, watched.touch.at, 1.1e-3);
  EXPECT_NEAR(reference.speed, watched.touch.speed, 0.05 * watched.touch.speed);
  EXPECT_NEAR(watched.touch.grip, reference.grip, 0.1 * reference.grip);
}

TEST(FirstTouch, LawConvergesAndWithoutStiffnessNothingPushes) {
  const models::Setup setup = session();
  const TouchRecord watched = watch_touch(setup, 1);
  const FirstTouch coarse = refer(setup, 1, watched, law(1e5, 0.6), 5e-6);
  const FirstTouch fine = refer(setup, 1, watched, law(1e5, 0.6), 2e-6);
  EXPECT_NEAR(coarse.grip, fine.grip, 2e-3 * fine.grip);
  EXPECT_NEAR(coarse.push, fine.push, 2e-3 * fine.push);
  EXPECT_TRUE(std::isnan(refer(setup, 1, watched, Law{0.0, 1.0, 0.0, 0.0, 0.6}, 5e-6).at));
}

}  // namespace
}  // namespace enc::bench::impact
