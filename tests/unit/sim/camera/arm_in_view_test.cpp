// The twin draws an arm where its shape says, and the belief of the same shape covers it: as long as it is
// right.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/rotation.h"
#include "core/vision/augment/part_mask.h"
#include "sim/camera/stage.h"
#include "trial/camera/arm_things.h"

namespace enc::trial {
namespace {

const Pose<'W', 'C'> kCamera(rotation_xyz({-2.18, 0.0, 0.52}), Vec3(0.236, -0.426, 0.457));

TEST(ArmInView, IsWhereItsShapeSays) {
  sim::StageSpec spec;
  spec.sensor.noise = 0.0;
  sim::Stage stage(spec);
  Image left, right;
  sim::PixelTruth truth;
  const Arm arm{ArmMachine{}};
  const Pose<'W', 'R'> X_WR(Quat::Identity(), Vec3(-arm.tip({}).e()));
  const RectifiedPair pair = Rectifier(spec.camera).pair();
  for (const PerJoint& q : {PerJoint{0, 0, 0}, PerJoint{0.3, 0.2, -0.1}, PerJoint{-0.4, -0.1, 0.3}}) {
    std::vector<ArmPart> parts = arm_shape(arm.machine(), q, X_WR);
    parts.push_back(
        prop_shape({0.03, 0.03, 0.002}, X_WR * arm.tip(q), rotation_z_to(Vec3(0.2, 0.1, 1).normalized())));
    sim::Shown shown;
    for (const ArmPart& part : parts) shown.things.push_back(thing_of(part, kCamera.inverse()));
    stage.draw(shown, 0, left, right, &truth);
    const auto share_in = [&](const Pose<'C', 'W'>& X_CW, double margin, double& beyond) {
      Mask mask(640, 480);
      for (const ArmPart& part : parts) augment::cover(pair, X_CW, part, margin, mask);
      int both = 0, drawn = 0, covered = 0;
      for (std::size_t i = 0; i < mask.on.size(); ++i) {
        both += mask.on[i] != 0 && truth.things.on[i] != 0 ? 1 : 0;
        drawn += truth.things.on[i] != 0 ? 1 : 0;
        covered += mask.on[i] != 0 ? 1 : 0;
      }
      EXPECT_GT(drawn, 5000);
      beyond = static_cast<double>(covered - both) / drawn;
      return static_cast<double>(both) / drawn;
    };
    double beyond = 0.0;
    EXPECT_GT(share_in(kCamera.inverse(), 0.0, beyond), 0.985);  // an edge is half a pixel off
    EXPECT_LT(beyond, 0.015);
    EXPECT_EQ(share_in(kCamera.inverse(), 1.5, beyond), 1.0);
    // The camera believed 5 mm beside where it is: 5 px.
    const Pose<'W', 'C'> off = kCamera * Pose<'C', 'C'>(Quat::Identity(), Vec3(0.005, 0, 0));
    EXPECT_LT(share_in(off.inverse(), 0.0, beyond), 0.95);
  }
}

}  // namespace
}  // namespace enc::trial
