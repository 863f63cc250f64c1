// A machine with dead time, lag and limits under random pushes: the damper and the passivity controller keep
// it passive.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/control/step.h"
#include "sim/plants/hexapod_plant.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

// ---- The core and a machine with dead time, lag and limits, with pushes on its tip along z.

class PushedMachine {
 public:
  // The wall rises to 15 mm above W's origin; the force has a noise of 0.015 N.
  PushedMachine(Scene scene, std::uint64_t seed)
      : loop_(std::move(scene)), machine_(sim::HexapodTruth{}, seed), random_(seed) {
    loop_.spoil = [this](Inputs& in) {
      in.tip.value = {machine_.true_pose(), machine_.state().velocity, machine_.state().acceleration};
    };
    loop_.scene.force.mass = 0.0;  // the sensor of this loop stands on the tip
  }
  PushedMachine(const PushedMachine&) = delete;
  PushedMachine& operator=(const PushedMachine&) = delete;

  // Ground truth: the tip's depth in the wall, m, and its velocity outwards, m/s.
  [[nodiscard]] double depth() const {
    return 0.015 - (loop_.scene.X_WR * machine_.true_pose().origin()).xyz[2] - loop_.scene.tip_radius;
  }
  [[nodiscard]] double velocity() const { return machine_.state().velocity.xyz[2]; }

  void tick(double push) {  // N, downwards
    loop_.force = Vec<'W'>(0, 0, -push - noise_(random_));
    loop_.tick();
    machine_.command(loop_.out.manipulator.tip);
    machine_.begin_cycle();
    machine_.move(1e-3);
  }

 private:
  Loop loop_;
  sim::HexapodPlant machine_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_{0.0, 0.015};
};

// ---- A spring pushes a machine with dead time, lag and limits: with the damper no pusher and no low
// stiffness causes a limit cycle.

constexpr double kLimit = 0.028;

struct Pusher {
  double stiffness, damping;  // N/m, N s/m
};

Scene wall(double stiffness, Damping damping) {
  RigSpec rig;
  rig.contact.softest = 0.0;
  rig.contact.leave_time = 0.5;
  rig.force.threshold = 0.0;
  rig.force.contact = 0.01;
  rig.force.tare = Tare::window;
  rig.admittance.damping = damping;
  SceneSpec spec = test::plane_scene(test::spring(stiffness, kLimit));
  spec.objects[0].position = Vec3(0, 0, 0.015);
  spec.tracker.reset();
  spec.tools.clear();
  return prepare(spec, rig);
}

// Peak to peak of the tip's depth, m, in each of the last three seconds of 12; the force has a noise of 0.015
// N.
std::array<double, 3> pushed(double object, const Pusher& pusher, Damping damping, std::uint64_t seed) {
  PushedMachine machine(wall(object, damping), seed);
  const double deep = std::min(0.015, 30.0 / object);
  const double reach = deep * (1.0 + object / pusher.stiffness);
  std::array<double, 3> least{1, 1, 1}, most{-1, -1, -1};
  for (int i = 0; i < 12000; ++i) {
    const double s = std::clamp((i * 1e-3 - 1.0) / 2.0, 0.0, 1.0);
    const double in = reach * s * s * s * (10.0 + s * (6.0 * s - 15.0));
    const double force =
        i < 1000
            ? 0.0
            : std::max(0.0, pusher.stiffness * (in - machine.depth()) + pusher.damping * machine.velocity());
    machine.tick(force);
    if (i < 9000) continue;
    const auto second = static_cast<std::size_t>((i - 9000) / 1000);
    least[second] = std::min(least[second], machine.depth());
    most[second] = std::max(most[second], machine.depth());
  }
  return {most[0] - least[0], most[1] - least[1], most[2] - least[2]};
}

TEST(DampingProperty, NoPusherMakesAnyWallSwing) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 40; ++i) {
    const double object = 3.0 * std::pow(1000.0 / 3.0, unit(random));
    const Pusher pusher{50.0 * std::pow(40.0, unit(random)), 4.0 * unit(random)};
    const std::array<double, 3> swing = pushed(object, pusher, Damping::observed, 100U + i);
    EXPECT_LT(*std::max_element(swing.begin(), swing.end()), 0.5e-3)
        << "wall " << object << " N/m, pusher " << pusher.stiffness << " N/m, " << pusher.damping << " N s/m";
  }
}

// The limit cycles exist without the damper, so the test above can fail.
TEST(DampingProperty, WithoutItASoftWallSwings) {
  const std::array<double, 3> swing = pushed(20.0, {1000.0, 2.2}, Damping::none, 1);
  EXPECT_GT(swing[2], 1e-3);
}

// ---- The passivity controller of a machine that measures force, with dead time, lag and limits. Any pusher
// on any stiffness, however low, gets at most the energy that it put in.

struct Hand {
  double stiffness, damping;  // N/m, N s/m
};

Scene held_wall(double stiffness, const Hand& hand, PassivityForm form) {
  RigSpec rig;
  rig.contact.softest = 0.0;
  rig.contact.hand_stiffness = hand.stiffness;
  rig.admittance.passivity = form;
  SceneSpec spec = test::plane_scene(test::spring(stiffness, 0.028));
  spec.objects[0].position = Vec3(0, 0, 0.015);
  spec.follow.inset = 0.05e-3;  // the machine gives away what the tip comes out by at the touch
  spec.tracker.reset();
  spec.tools.clear();
  return prepare(spec, rig);
}

// Energy in J from the tip's true path and the true force, along three pushes of a hand that cannot pull.
struct EnergyExchange {
  double put = 0.0, out = 0.0;  // largest energy put in; largest surplus that came out
  int bounces = 0;              // losses of contact while the hand presses
};
EnergyExchange exchanged_when_pushed(double object, const Hand& hand, PassivityForm form,
                                     std::uint64_t seed) {
  PushedMachine machine(held_wall(object, hand, form), seed);
  const double deep = std::min(0.015, 30.0 / object);
  const double reach = deep * (1.0 + object / hand.stiffness);
  constexpr double kPeriod = 8.0, kWaits = 2e-3;  // s; m off the surface
  EnergyExchange all;
  double given = 0.0, before = machine.depth(), push = 0.0;
  for (int i = 0; i < 25000; ++i) {
    const double t = i < 1000 ? 0.0 : std::fmod(i * 1e-3 - 1.0, kPeriod);
    const double u = std::clamp(t < 3.5 ? t : kPeriod - 2.5 - t, 0.0, 1.0);
    const double in = (reach + kWaits) * u * u * u * (10.0 + u * (6.0 * u - 15.0)) - kWaits;
    const double depth = machine.depth();
    const double now = std::max(0.0, hand.stiffness * (in - depth) + hand.damping * machine.velocity());
    if (push > 0.0 && now == 0.0 && u == 1.0) ++all.bounces;
    given -= 0.5 * (push + now) * (depth - before);
    before = depth;
    if (t < 1e-3) given = 0.0;  // a new push begins
    all.out = std::max(all.out, given);
    all.put = std::max(all.put, -given);
    push = now;
    machine.tick(push);
  }
  return all;
}

TEST(SpareProperty, NoHandGetsMoreOutThanItHasPutIn) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (std::uint64_t i = 0; i < 30; ++i) {
    const double object = 5.0 * std::pow(400.0, unit(random));
    const Hand hand{100.0 * std::pow(20.0, unit(random)), 1.0 + 7.0 * unit(random)};
    const EnergyExchange with = exchanged_when_pushed(object, hand, PassivityForm::controlled, i);
    EXPECT_LE(with.out, 0.1e-3) << "wall " << object << " N/m, hand " << hand.stiffness << " N/m, "
                                << hand.damping << " N s/m";
    EXPECT_GT(with.put, 0.1e-3) << "it is pressed";
  }
}

// The surplus exists without the controller, so the test above can fail.
TEST(SpareProperty, WithoutItASoftWallPaysOut) {
  const EnergyExchange without = exchanged_when_pushed(30.0, {700.0, 4.0}, PassivityForm::none, 1);
  EXPECT_GT(without.out, 2e-3);
  EXPECT_GT(without.bounces, 5);
}

// A stable wall returns as much energy as before, to its end.
TEST(SpareProperty, AWallThatIsStableIsLeftAsItIs) {
  for (const double object : {300.0, 1000.0, 5000.0}) {
    const EnergyExchange off = exchanged_when_pushed(object, {700.0, 4.0}, PassivityForm::none, 3),
                         on = exchanged_when_pushed(object, {700.0, 4.0}, PassivityForm::controlled, 3);
    EXPECT_NEAR(on.put, off.put, 0.01 * off.put) << object;
    EXPECT_LE(off.out, 0.1e-3) << object;
  }
}

}  // namespace
}  // namespace enc
