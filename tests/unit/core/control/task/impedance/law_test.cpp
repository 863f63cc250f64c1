// The control law of an arm, piece by piece [VisHap eq. 2, 3, 6, 7; Fig 4].
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/rotation.h"
#include "core/control/safety/certificate/certificate.h"
#include "core/control/task/impedance/impedance.h"
#include "tests/support/by_hand.h"

namespace enc {
namespace {

TEST(LowPass, IsTheFormulaOfThePaper) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (const double a : {1e-3, 0.1, 0.75, 5.0}) {
    double y = 0.0, wanted = 0.0;
    for (int i = 0; i < 10000; ++i) {
      const double x = even(draw);
      y = low_pass(a, x, y);
      wanted = wanted / (1.0 + a) + x * (a / (1.0 + a));
      ASSERT_NEAR(y, wanted, 1e-12);
    }
  }
}

// Amplitude of the answer to a sine, by correlation over whole periods.
double gain_at(double a, double hz, double dt) {
  const auto ticks = static_cast<int>(std::lround(200.0 / (hz * dt)));
  double y = 0.0;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < 2 * ticks; ++i) {
    const double angle = 2.0 * std::numbers::pi * hz * dt * i;
    y = low_pass(a, std::sin(angle), y);
    if (i >= ticks) sum += y * std::exp(std::complex<double>(0.0, -angle));
  }
  return 2.0 * std::abs(sum) / ticks;
}

TEST(LowPass, MinusThreeDecibelsWhereItSays) {
  constexpr double dt = 1e-3;
  for (const double hz : {5.0, 20.0, 120.0}) {
    const double a = 2.0 * std::numbers::pi * hz * dt, corner = corner_frequency(a, dt);
    EXPECT_NEAR(gain_at(a, corner, dt), std::numbers::sqrt2 / 2.0, 2e-3) << hz;
    // The discrete corner tends to the s-domain corner: 20 Hz at 1 kHz is about 2 % lower.
    EXPECT_LT(std::abs(corner / hz - 1.0), 0.6 * a) << hz;
  }
  EXPECT_NEAR(corner_frequency(2.0 * std::numbers::pi * 1.0 * 1e-6, 1e-6), 1.0, 1e-5);
}

TEST(GainMatrix, IsSymmetricAndKeepsItsEigenvalues) {
  std::mt19937_64 draw(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Quat q = Quat(normal(draw), normal(draw), normal(draw), normal(draw)).normalized();
    const Mat3 R = q.toRotationMatrix();
    const double along = 0.1 + 5.0 * std::abs(normal(draw));
    const Mat3 wanted = R * Vec3(1.0, 1.0, along).asDiagonal() * R.transpose();  // eq. 7
    const Mat3 gain = gain_matrix(R.col(2), 1.0, along);
    EXPECT_LT((gain - wanted).norm(), 1e-12);
    EXPECT_LT((gain - gain.transpose()).norm(), 1e-12);
    Vec3 eigen = Eigen::SelfAdjointEigenSolver<Mat3>(gain).eigenvalues();
    Vec3 given(1.0, 1.0, along);
    std::sort(given.data(), given.data() + 3);
    EXPECT_LT((eigen - given).norm(), 1e-12);
  }
}

InteractionSpec button() {
  InteractionSpec spec;
  spec.kind = Interaction::click;
  spec.trigger = 2e-3;
  spec.bottom = 4e-3;
  spec.after = 200.0;
  spec.floor = 600.0;
  spec.gradual = 0.5e-3;
  return spec;
}

double force_at(const InteractionSpec& spec, double stiffness, double depth) {
  const RenderedStiffness felt = felt_at(spec, stiffness, 300.0, depth);
  return felt.stiffness * (depth - felt.sunk);
}

TEST(FeltAt, WallIsASpringBeyondItsFirstHalfMillimetre) {
  InteractionSpec wall{.kind = Interaction::slide, .gradual = 0.5e-3};
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 0.0).stiffness, 300.0);  // K_p: the stiffness in free space
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 0.5e-3).stiffness, 600.0);
  EXPECT_DOUBLE_EQ(felt_at(wall, 600.0, 300.0, 8e-3).stiffness, 600.0);
}

TEST(FeltAt, ButtonHasThreeSlopes) {
  const InteractionSpec spec = button();
  const auto slope = [&](double depth) {
    return (force_at(spec, 400.0, depth + 1e-6) - force_at(spec, 400.0, depth - 1e-6)) / 2e-6;
  };
  EXPECT_NEAR(slope(1.5e-3), 400.0, 1e-6);
  EXPECT_NEAR(slope(3.5e-3), 200.0, 1e-6);
  EXPECT_NEAR(slope(5.0e-3), 600.0, 1e-6);
  EXPECT_NEAR(force_at(spec, 400.0, 2e-3), 0.8, 1e-9);
  EXPECT_NEAR(force_at(spec, 400.0, 2.5e-3), 0.5, 1e-9);  // the click
  EXPECT_NEAR(force_at(spec, 400.0, 4e-3), 0.8, 1e-9);    // the bottom takes over without a step
}

TEST(FeltAt, ForceIsContinuousAtEveryDepth) {
  const InteractionSpec spec = button();
  for (double depth = 0.0; depth < 8e-3; depth += 1e-6)
    EXPECT_LT(std::abs(force_at(spec, 400.0, depth + 1e-6) - force_at(spec, 400.0, depth)), 3e-3) << depth;
}

TEST(FeltAt, AtOnceLeapsWhereItTriggers) {
  InteractionSpec spec = button();
  spec.gradual = 0.0;
  EXPECT_NEAR(force_at(spec, 400.0, 2e-3 - 1e-9) - force_at(spec, 400.0, 2e-3), 0.4, 1e-5);
  EXPECT_NEAR(force_at(spec, 400.0, 4e-3 - 1e-9) - force_at(spec, 400.0, 4e-3), 0.0, 1e-5);
}

// The loop along one direction of an arm's tip.

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
  // Each slide moves half: by the work, x v^2 + z v^2 of the rates of the masses.
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

// docs/reference/plane_button.md has the eigenvalues of this loop: 1213 to 2378 N/m.
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

// An arm at rest while the finger is far: friction holds it, and the law leaves it alone.

using Bench = test::FingerBench;

// One count of each joint's encoder, read with a window of 2 ms: there, and unchanged in the next ticks.
// Return the change of the push, N.
double strays_by_a_count(Bench& bench) {
  const Impedance& law = *bench.loop.scene.impedance();
  ArmSample& arm = bench.loop.in.arm.value;
  const Vec3 before = bench.loop.out.force_unfiltered.e();
  double most = 0.0;
  for (std::size_t joint = 0; joint < kMostJoints; ++joint) {
    const double count = 2.0 * M_PI / 4096.0 / law.rig.machine.drives[joint].ratio;
    const Mat3 jacobian = law.arm.jacobian(arm.joints);
    arm.joints[joint] += count;
    arm.tip = law.arm.tip(arm.joints);
    arm.velocity = Vec<'R'>(Vec3(jacobian.col(static_cast<Eigen::Index>(joint)) * (count / 2e-3)));
    for (int tick = 0; tick < 100; ++tick) {
      bench.at(-0.150);
      most = std::max(most, (bench.loop.out.force_unfiltered.e() - before).norm());
      if (tick == 1) arm.velocity = Vec<'R'>::zero();
    }
  }
  return most;
}

// Friction at stretched arms holds the tip 4.5 mm from its target [sources/arm 3]. One count's rate through
// K_v would push with 0.2 N, and the tip would slip at 1 mm/s.
TEST(Rest, ACountMovesNothingWhereFrictionHoldsTheArmFarFromItsTarget) {
  for (const double off : {0.0, 1e-3, 4.5e-3, 9e-3}) {
    Bench bench("wall");
    bench.at(-0.150, 10);
    bench.put_tip({0.9 * off, 0.3 * off, 0.3 * off});
    bench.at(-0.150, 2000);
    EXPECT_LT(strays_by_a_count(bench), 0.02) << off;
  }
}

// An arm that slipped while its push faded stands with the full push, and a count must not move it.
TEST(Rest, ACountMovesNothingWhereTheArmHasSlipped) {
  Bench bench("wall");
  bench.at(-0.150, 10);
  bench.put_tip({4e-3, 0.0, 2e-3});
  bench.at(-0.150, 60);
  bench.put_tip({3.8e-3, 0.0, 1.9e-3});
  bench.at(-0.150, 2000);
  ASSERT_TRUE(recall<ImpedanceState>(bench.loop.state).aim.slipped);
  EXPECT_GT(bench.loop.out.force_unfiltered.norm(), 1.0);
  EXPECT_LT(strays_by_a_count(bench), 0.02);
}

// A push that moves the arm farther than friction would let it creep ends the rest.
TEST(Rest, AnArmThatIsPushedIsBroughtBack) {
  Bench bench("wall");
  bench.at(-0.150, 2000);
  bench.put_tip({0.0, 0.0, 2e-3});
  bench.at(-0.150, 30);
  EXPECT_GT(bench.loop.out.force_unfiltered.norm(), 0.5);  // 300 N/m over 2 mm
}

// The stiffest wall that a certificate allows against the arm's own motion: joints, law and delay line in
// time, also with sideways motion of the tip. This uses no code of core/control/safety/certificate.

constexpr double kPeriod = 1e-3;  // s
constexpr int kParts = 10;        // per period: delays are whole parts

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

// The shipped rig; one with a long forearm and a light prop; and one with heavy links, delay and a soft law.
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

// State change of the joints in a part of a period, free and for each torque: M q'' + D q' = torque, with the
// hand's spring and damper along the normal, by a Runge-Kutta step.
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

// The law of eq. 2, 3 and 7 around a target at rest, for this many periods. Return true if the motion grows
// in the end. A ball that is hit is only a spring; a real object is held in all directions.
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

// Poses of the arm, and normals of any tilt.
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

// Two slides, one on the other: the normal of a wall is seldom a direction of motion.
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

// A delay of many periods: the certificate counts the eigenvalues without their matrix there.
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

// Along the normal alone the loop would be stable, so a release along the normal shows nothing.
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
