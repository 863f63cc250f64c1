// The loop along one way of an arm's tip.
#include "core/control/task/meet/arm_loop.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/control/safety/certificate/certificate.h"
#include "tests/support/finger_bench.h"

namespace enc {
namespace {

const Vec<'R'> kUp(0, 0, 1), kAlong(1, 0, 0);
const certificate::Hand kHand{0.0, 4.0, 700.0};

// Slides along x and z of 0.3 kg and 0.1 kg, with rotors of 1e-6 kg m^2 times 100^2.
Impedance stage() {
  ArmRig rig;
  rig.machine.kind = ArmKind::chain;
  rig.machine.links = {{"x", JointKind::slide, {1, 0, 0}, {0, 0, 0}, 0.2}, {"z", JointKind::slide}};
  for (ArmDrive& drive : rig.machine.drives) drive = {-0.1, 0.1, 100.0, 1e-6};
  rig.stiffness = 300.0;
  rig.damping = 12.0;
  rig.loop = ArmLoop{{0.05, 0.04, 9.0}, {0.5, 0.3, 9.0}, {2000.0, 1000.0, 1.0}, 0.003, 0.001};
  Impedance law{Arm(rig.machine), rig};
  law.prop_mass = 0.02;
  law.filter_gain = 0.4;
  law.home_mass = law.arm.felt_mass(law.arm.jacobian({}), law.arm.mass({}, law.prop_mass));
  return law;
}

TEST(ArmLoop, OfASlideIsWhatTheSlideIs) {
  const ArmLoopAt up = loop_at(stage(), kHand, 1e-3, {}, kUp, 900.0, Interaction::slide);
  EXPECT_NEAR(up.loop.mass, 0.1 + 0.02 + 0.01, 1e-12);
  EXPECT_NEAR(up.loop.damping, 0.3, 1e-12);
  EXPECT_NEAR(up.steps.friction, 0.04, 1e-12);
  EXPECT_NEAR(up.steps.encoder, 2.0 * M_PI / (1000.0 * 100.0), 1e-15);
  EXPECT_EQ(up.loop.ticks, 3);
  EXPECT_EQ(up.loop.delay, 1e-3);
  EXPECT_EQ(up.loop.filter, 0.4);
  EXPECT_NEAR(up.asked.damper.ratio, 12.0 / 300.0, 1e-12);  // all of K_v, as heavy as at home
  EXPECT_EQ(up.asked.damper.fixed, 0.0);
  EXPECT_EQ(up.loop.hand.stiffness, 700.0);
  const ArmLoopAt along = loop_at(stage(), kHand, 1e-3, {}, kAlong, 900.0, Interaction::slide);
  EXPECT_NEAR(along.loop.damping, 0.5, 1e-12);
  EXPECT_NEAR(along.steps.encoder, 2.0 * M_PI / (2000.0 * 100.0), 1e-15);
  // Half of each way: by the work, x v^2 + z v^2 of the rates that the masses take.
  const double h = std::sqrt(0.5), mx = 0.33, mz = 0.13;  // kg: the first slide carries the second
  const ArmLoopAt aslant = loop_at(stage(), kHand, 1e-3, {}, Vec<'R'>(h, 0, h), 900.0, Interaction::slide);
  const double m = 1.0 / (0.5 / mx + 0.5 / mz), vx = m * h / mx, vz = m * h / mz;
  EXPECT_NEAR(h * vx + h * vz, 1.0, 1e-12);
  EXPECT_NEAR(aslant.loop.damping, 0.5 * vx * vx + 0.3 * vz * vz, 1e-12);
  EXPECT_NEAR(aslant.steps.friction, 0.05 * vx + 0.04 * vz, 1e-12);
}

TEST(ArmLoop, ABallThatFliesIsASpringAlone) {
  const ArmLoopAt ball = loop_at(stage(), kHand, 1e-3, {}, kUp, 900.0, Interaction::hit);
  EXPECT_TRUE(std::isnan(ball.loop.filter));
  EXPECT_EQ(ball.asked.damper.at(900.0), 0.0);
}

TEST(ArmLoop, WhatTheRigDoesNotSayIsNotKnown) {
  Impedance law = stage();
  law.rig.loop.reset();
  const ArmLoopAt at = loop_at(law, kHand, 1e-3, {}, kUp, 900.0, Interaction::slide);
  const certificate::Certificate found = certificate::certify(at.loop, at.steps, at.asked);
  EXPECT_EQ(found.verdict, certificate::Class::unknown);
  EXPECT_EQ(found.missing, "damping");
}

// docs/reference/plane_button.md has the eigenvalues of the same loop: 1213 to 2378 N/m.
TEST(ArmLoop, TheStiffestSpringIsThatOfTheDocumentedLoop) {
  const auto near = [&](double filter, double mass, double wanted) {
    certificate::SampledLoop loop{mass, 0.0, 1e-3};
    loop.ticks = 2;
    loop.filter = 2.0 * M_PI * filter * 1e-3;
    EXPECT_NEAR(certificate::critical_stiffness(loop, {0.0, 11.5 / 300.0}), wanted, 0.05 * wanted)
        << filter << " Hz, " << mass << " kg";
  };
  near(30.0, 0.047, 1056.0);
  near(60.0, 0.054, 1352.0);
  near(60.0, 0.067, 1677.0);
  near(120.0, 0.095, 2575.0);
}

}  // namespace
}  // namespace enc
