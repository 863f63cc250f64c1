// What the machine cannot carry is not rendered, and a hand that pushes harder finds it standing still.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "core/devices/mode.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

RigSpec weak(double payload) {
  RigSpec rig;
  rig.manipulator.payload = payload;
  return rig;
}

// 13 N less 0.91 kg * 9.80665 m/s^2 = 4.07595 N; a spring of 2 N/mm reaches that at 2.037974 mm.
TEST(Payload, CutsTheDeflectionWhereTheForceReachesIt) {
  const Scene scene = prepare(test::ball_scene(), weak(13.0));
  EXPECT_NEAR(scene.strength, 4.0759485, 1e-9);
  EXPECT_NEAR(scene.objects[0].limit, 2.03797425e-3, 1e-12);
  EXPECT_EQ(scene.objects[0].wanted, 6e-3);
  const Scene strong = prepare(test::ball_scene(), {});
  EXPECT_EQ(strong.objects[0].limit, 6e-3);
  EXPECT_EQ(strong.objects[0].wanted, 6e-3);
}

TEST(Payload, RefusesAMachineThatCarriesNothing) {
  EXPECT_THROW((void)prepare(test::ball_scene(), weak(8.9)), Error);
  EXPECT_THROW((void)prepare(test::ball_scene(), weak(9.0)), Error) << "0.08 N are felt before the inset";
}

TEST(Payload, PushedHarderItStandsAtTheLimitAndSaysSo) {
  Loop loop(prepare(test::ball_scene(), weak(13.0)));
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius + 0.020);
  loop.tick(1000);
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.0);
  loop.tick(2000);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_FALSE(loop.out.why & kOverload);
  loop.force = Vec<'W'>(0, 0, -12.0);
  loop.tick(2000);
  const Point<'W'> there = loop.tip();
  EXPECT_EQ(loop.out.mode, Mode::contact) << "no hold: the machine stands, which is the safe thing";
  EXPECT_TRUE(loop.out.why & kOverload);
  EXPECT_TRUE(loop.out.why & kAtLimit);
  EXPECT_NEAR(loop.out.deflection, loop.scene.objects[0].limit, 1e-12);
  EXPECT_NE(why_text(loop.out.why).find("pressed harder than the machine carries"), std::string::npos);
  loop.force = Vec<'W'>(0, 0, -90.0);
  loop.tick(1000);
  EXPECT_LT((loop.tip() - there).norm(), 1e-9);
}

}  // namespace
}  // namespace enc
