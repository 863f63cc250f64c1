// The coordinates of OpenHaptics HD and ours, and the words of its errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/machine/arm.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/wire/coordinates.h"
#include "hw_drivers/phantom/wire/hd.h"
#include "tests/support/refusal.h"

namespace enc::phantom {
namespace {

using ::testing::HasSubstr;

// HD: x to the right of the person, y up, z towards the person. R: x towards the person, z up; so y is to the
// person's right.
TEST(HdCoordinates, EachAxisHasItsPlace) {
  EXPECT_EQ(axes_to_ours(Vec3(1, 0, 0)), Vec3(0, 1, 0));
  EXPECT_EQ(axes_to_ours(Vec3(0, 1, 0)), Vec3(0, 0, 1));
  EXPECT_EQ(axes_to_ours(Vec3(0, 0, 1)), Vec3(1, 0, 0));
  const Vec3 force(0.1, -2.5, 3.75);
  EXPECT_EQ(axes_to_ours(axes_to_hd(force)), force) << "to the bit";
}

// Cavusoglu, Feygin and Tendick: x = sin q1 (l1 cos q2 + l2 sin q3), with the turret turning to the left,
// y = l2 - l2 cos q3 + l1 sin q2, z = cos q1 (l1 cos q2 + l2 sin q3) - l1.
TEST(HdCoordinates, AreThoseOfThePublishedKinematics) {
  const Arm arm{ArmMachine{}};
  const PhantomGeometry& g = arm.machine().phantom;
  const Point<'R'> origin = arm.tip(arm.zero());
  const PerJoint q{0.3, -0.2, 0.5};
  const Vec3 mm = hd_point(arm.tip(q), origin);
  const double reach = g.l1 * std::cos(q[1]) + g.l2 * std::sin(q[2]);
  EXPECT_NEAR(mm.x(), 1e3 * std::sin(q[0]) * reach, 1e-9);
  EXPECT_NEAR(mm.y(), 1e3 * (g.l2 - g.l2 * std::cos(q[2]) + g.l1 * std::sin(q[1])), 1e-9);
  EXPECT_NEAR(mm.z(), 1e3 * (std::cos(q[0]) * reach - g.l1), 1e-9);
  EXPECT_LT((point_of(mm, origin) - arm.tip(q)).norm(), 1e-15);
}

TEST(HdErrors, HaveWordsAndTheWayOut) {
  EXPECT_EQ(hd::words_of(hd::kWarmMotors), "HD_WARM_MOTORS (0x0200): the motors are too warm; let them cool");
  EXPECT_EQ(hd::words_of(0x1234), "HD error 0x1234");
  EXPECT_FALSE(hd::is_grave(hd::kMaxForce));
  EXPECT_TRUE(hd::is_grave(hd::kCommError));
}

TEST(PhantomSettings, ADeviceOfTheFakeIsAPlace) {
  PhantomSettings settings;
  EXPECT_EQ(settings.fake_place().port, 18970);
  settings.device = "localhost:4000";
  EXPECT_EQ(settings.fake_place().host, "localhost");
  settings.device = "Default Device";
  EXPECT_THAT(test::refusal([&] { static_cast<void>(settings.fake_place()); }),
              HasSubstr("expected HOST:PORT"));
}

}  // namespace
}  // namespace enc::phantom
