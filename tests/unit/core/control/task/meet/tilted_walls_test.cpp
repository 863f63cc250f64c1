// The stiffest wall that a certificate allows against the arm's own motion: joints, law and delay line in
// time, where the tip goes sideways as well. Nothing of core/control/safety/certificate is used for that.
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/control/safety/certificate/certificate.h"
#include "core/control/task/meet/arm_loop.h"

namespace enc {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr int kParts = 10;        // of a period: delays are whole parts

struct Rig {
  std::string name;
  Impedance law;
};

Impedance law_of(const ArmRig& rig, double prop) {
  Impedance law{Arm(rig.machine), rig};
  law.prop_mass = prop;
  law.filter_gain = 2.0 * std::numbers::pi * rig.filter * kPeriod;
  law.home_mass = law.arm.felt_mass(law.arm.jacobian({}), law.arm.mass({}, prop));
  return law;
}

// The shipped one; one with a long forearm of a light prop; and one with heavy links, delay and a soft law.
std::array<Rig, 3> rigs() {
  ArmRig shipped;
  shipped.loop.emplace();
  ArmRig lengthy = shipped;
  lengthy.machine.phantom.l2 = 0.2;
  lengthy.machine.phantom.m_a = 0.05;
  ArmRig heavy = shipped;
  heavy.machine.phantom.m_a = 0.12;
  heavy.machine.phantom.m_c = 0.08;
  heavy.machine.phantom.I_base = 2e-3;
  heavy.loop->delay = 1.3e-3;
  heavy.loop->viscous = {0.002, 0.001, 0.004};
  heavy.damping = 16.0;
  return {Rig{"shipped", law_of(shipped, 0.02)}, Rig{"long forearm", law_of(lengthy, 0.005)},
          Rig{"heavy links", law_of(heavy, 0.03)}};
}

// What joints become in a part of a period by themselves and by each torque: of M q'' + D q' = torque, with
// the hand's spring and damper along the normal, by a Runge-Kutta step.
class Joints {
 public:
  Joints(const Impedance& law, const PerJoint& q, const Vec3& normal, const certificate::Hand& hand) {
    const double h = kPeriod / kParts, kAside = 1e-6;
    for (std::size_t i = 0; i < 3; ++i) {  // the Jacobian by differences
      PerJoint more = q, less = q;
      more[i] += kAside;
      less[i] -= kAside;
      J.col(static_cast<int>(i)) = (law.arm.tip(more).e() - law.arm.tip(less).e()) / (2.0 * kAside);
    }
    Mat3 inertia = law.arm.mass(q, law.prop_mass);
    for (auto i = static_cast<int>(law.arm.joints()); i < 3; ++i) inertia(i, i) = 1.0;  // stands still
    const Eigen::FullPivLU<Mat3> mass(inertia);
    const Vec3 pushed = J.transpose() * normal;
    Mat3 damping = hand.damping * pushed * pushed.transpose();
    for (int i = 0; i < 3; ++i) damping(i, i) += law.rig.loop->viscous[static_cast<std::size_t>(i)];
    const Mat3 spring = hand.stiffness * pushed * pushed.transpose();
    using State = Eigen::Matrix<double, 6, 1>;
    const auto rate = [&](const State& s, const Vec3& torque) {
      State found;
      found << s.tail<3>(), mass.solve(torque - damping * s.tail<3>() - spring * s.head<3>());
      return found;
    };
    const auto step = [&](const State& s, const Vec3& torque) {
      const State a = rate(s, torque), b = rate(s + 0.5 * h * a, torque), c = rate(s + 0.5 * h * b, torque),
                  d = rate(s + h * c, torque);
      return State(s + h / 6.0 * (a + 2.0 * b + 2.0 * c + d));
    };
    for (int i = 0; i < 6; ++i) free.col(i) = step(State::Unit(i), Vec3::Zero());
    for (int i = 0; i < 3; ++i) forced.col(i) = step(State::Zero(), Vec3::Unit(i));
  }
  Mat3 J;
  Eigen::Matrix<double, 6, 6> free;
  Eigen::Matrix<double, 6, 3> forced;
};

// The law of eq. 2, 3 and 7 around a target at rest, for so many periods; whether the motion grows in the
// end.
// A ball that is hit is a spring alone; a real thing is held in all directions.
bool grows(const Impedance& law, const PerJoint& q, const Joints& joints, const Vec3& normal,
           double stiffness, Interaction kind) {
  constexpr int kTicks = 8000;
  const ArmLoop& known = *law.rig.loop;
  const auto window = static_cast<std::size_t>(std::lround(known.velocity_window / kPeriod));
  const auto late = static_cast<std::size_t>(std::lround(known.delay / kPeriod * kParts));
  const double a = law.filter_gain;
  const double damping = damping_at(law, law.arm.felt_mass(joints.J, law.arm.mass(q, law.prop_mass)));
  const double along = stiffness / law.rig.stiffness, across = kind == Interaction::passive ? along : 1.0;
  const Mat3 gain = gain_matrix(normal, across, along);
  Eigen::Matrix<double, 6, 1> state;
  state << 3e-3, -2e-3, law.arm.joints() == 3 ? 1e-3 : 0.0, 0.0, 0.0, 0.0;
  std::deque<Vec3> tips(window, Vec3(joints.J * state.head<3>())), torques(late + 1, Vec3(Vec3::Zero()));
  Vec3 error = Vec3::Zero(), rate = Vec3::Zero(), torque = Vec3::Zero();
  double largest[4] = {};
  for (int tick = 0; tick < kTicks; ++tick) {
    const Vec3 tip = joints.J * state.head<3>(), speed = (tip - tips.back()) / known.velocity_window;
    tips.push_front(tip);
    tips.pop_back();
    error = (error - a * tip) / (1.0 + a);
    rate = (rate - a * speed) / (1.0 + a);
    Vec3 force = gain * (law.rig.stiffness * error + damping * rate);
    if (kind == Interaction::hit) force -= normal * (stiffness * normal.dot(tip) + normal.dot(force));
    torque = joints.J.transpose() * force;
    for (int part = 0; part < kParts; ++part) {
      torques.push_front(torque);
      torques.pop_back();
      state = joints.free * state + joints.forced * torques.back();
    }
    double& most = largest[tick * 4 / kTicks];
    most = std::max(most, state.norm());
    if (most > 1e6) return true;
  }
  return largest[3] > largest[2];
}

struct Wall {
  PerJoint q{};
  Vec3 normal;
};

// Poses that the arm takes, and normals of any tilt.
std::vector<Wall> walls_of(const Impedance& law, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Wall> found;
  while (found.size() < count) {
    const PerJoint q{0.6 * unit(random), 0.5 * unit(random), 0.6 * unit(random)};
    const Vec3 normal(unit(random), unit(random), unit(random));
    if (!(normal.norm() > 0.2 && normal.norm() < 1.0) || !law.arm.within_limits(q) ||
        law.arm.dexterity(law.arm.jacobian(q)) < 0.2)
      continue;
    found.push_back({q, normal.normalized()});
  }
  return found;
}

void expect_at_the_bound(const Rig& rig, const Wall& wall, const certificate::Hand& hand, Interaction kind) {
  const ArmLoopAt at = loop_at(rig.law, hand, kPeriod, wall.q, Vec<'R'>(wall.normal), 600.0, kind);
  const double bound = certificate::critical_stiffness(at.loop, at.asked.damper);
  const Joints joints(rig.law, wall.q, wall.normal, hand);
  const std::string what = rig.name + ", " + std::to_string(bound) + " N/m, hand of " +
                           std::to_string(hand.stiffness) + ", " + std::string(word_of(kind));
  EXPECT_FALSE(grows(rig.law, wall.q, joints, wall.normal, 0.97 * bound, kind)) << what;
  EXPECT_TRUE(grows(rig.law, wall.q, joints, wall.normal, 1.03 * bound, kind)) << what;
}

const certificate::Hand kNobody{}, kExpectedHand{0.0, 4.0, 700.0};

TEST(TiltedWalls, AreCertifiedWithinThreePercentOfTheWholeArm) {
  unsigned seed = 1;
  for (const Rig& rig : rigs())
    for (const Wall& wall : walls_of(rig.law, 20, seed++))
      for (const certificate::Hand& hand : {kNobody, kExpectedHand})
        expect_at_the_bound(rig, wall, hand, Interaction::slide);
}

TEST(TiltedWalls, BallsThatAreHitAndRealThingsAreCertifiedLikewise) {
  unsigned seed = 11;
  for (const Rig& rig : rigs())
    for (const Wall& wall : walls_of(rig.law, 4, seed++))
      for (const certificate::Hand& hand : {kNobody, kExpectedHand})
        for (const Interaction kind : {Interaction::hit, Interaction::passive})
          expect_at_the_bound(rig, wall, hand, kind);
}

// Of two slides, which carry each other, a wall's normal is seldom a way that they go.
TEST(TiltedWalls, OfAMachineWithTwoJointsAreCertifiedLikewise) {
  ArmRig rig;
  rig.machine.kind = ArmKind::chain;
  rig.machine.links = {{"x", JointKind::slide, {1, 0, 0}, {0, 0, 0}, 0.2},
                       {"z", JointKind::slide, {0.6, 0, 0.8}, {0, 0, 0}, 0.1}};
  for (ArmDrive& drive : rig.machine.drives) drive = {-0.6, 0.6, 100.0, 1e-6};
  rig.loop = ArmLoop{{0.0, 0.0, 0.0}, {0.5, 0.3, 0.0}, {2000.0, 1000.0, 1.0}, 0.002, 0.0};
  const Rig two{"two slides", law_of(rig, 0.02)};
  for (const Wall& wall : walls_of(two.law, 8, 31))
    for (const certificate::Hand& hand : {kNobody, kExpectedHand})
      expect_at_the_bound(two, wall, hand, Interaction::slide);
}

// A delay of many periods: the eigenvalues are counted without their matrix there.
TEST(TiltedWalls, ALongDelayIsCounted) {
  for (Rig& rig : rigs()) {
    ArmRig late = rig.law.rig;
    late.loop->delay = 25.6e-3;
    rig.law.rig = late;
    for (const Wall& wall : walls_of(rig.law, 3, 21)) {
      const ArmLoopAt at =
          loop_at(rig.law, kExpectedHand, kPeriod, wall.q, Vec<'R'>(wall.normal), 600.0, Interaction::slide);
      for (const double stiffness : {10.0, 30.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 5000.0}) {
        const double damper = at.asked.damper.at(stiffness);
        EXPECT_EQ(certificate::stable(at.loop, stiffness, damper),
                  certificate::spectral_radius(at.loop, stiffness, damper) < 1.0)
            << rig.name << " " << stiffness;
      }
    }
  }
}

// Along the normal alone it would be stable. So a release along the normal tells nothing.
TEST(TiltedWalls, WhatOnlyTheNormalHoldsIsUnstable) {
  const Rig rig = rigs()[1];
  int seen = 0;
  for (const Wall& wall : walls_of(rig.law, 20, 2)) {
    ArmLoopAt at =
        loop_at(rig.law, kNobody, kPeriod, wall.q, Vec<'R'>(wall.normal), 600.0, Interaction::slide);
    const double bound = certificate::critical_stiffness(at.loop, at.asked.damper),
                 alone = certificate::critical_stiffness(at.loop.along(), at.asked.damper);
    if (!(bound < 0.97 * alone)) continue;
    ++seen;
    at.asked.stiffness = std::sqrt(bound * alone);
    const certificate::Certificate found = certificate::certify(at.loop, at.steps, at.asked);
    EXPECT_EQ(found.verdict, certificate::Class::unstable);
    EXPECT_EQ(found.small.rest, certificate::Rest::unknown);
    EXPECT_FALSE(certificate::row_of(found, "gil_hulin").applies);
  }
  EXPECT_GE(seen, 3);
}

}  // namespace
}  // namespace enc
