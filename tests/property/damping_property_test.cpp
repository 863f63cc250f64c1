// A machine with dead time, lag and limits, pushed by a spring: with the damper no pusher and no softness
// makes it swing.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/control/step.h"
#include "tests/property/pushed_machine.h"

namespace enc {
namespace {

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

// Peak to peak of the tip's depth, m, in each of the last three seconds of 12; a noise of 0.015 N rides on
// the force.
std::array<double, 3> pushed(double object, const Pusher& pusher, Damping damping, std::uint64_t seed) {
  test::PushedMachine machine(wall(object, damping), seed);
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

// Without it they do, so the test above can fail.
TEST(DampingProperty, WithoutItASoftWallSwings) {
  const std::array<double, 3> swing = pushed(20.0, {1000.0, 2.2}, Damping::none, 1);
  EXPECT_GT(swing[2], 1e-3);
}

}  // namespace
}  // namespace enc
