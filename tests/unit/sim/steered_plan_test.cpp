// A steered hand is as fast and as strong as a person's, and pushes along the normal.
#include "sim/hand/steered_plan.h"

#include <gtest/gtest.h>

namespace enc::sim {
namespace {

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

// The tip stands on a surface; the mouse is drawn into it, a little aside.
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
