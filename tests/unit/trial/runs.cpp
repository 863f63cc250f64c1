#include "tests/unit/trial/runs.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "trial/measure/press_measure.h"

namespace enc::test {

models::Setup shipped(const std::string& name, const Set& set, const std::string& rig) {
  return models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", rig, set);
}
models::Setup scene(const std::string& name, const Set& set) { return shipped(name, set, "sim"); }

Set quick(const Set& more) {
  Set set{"user.approach_mm_s=[50]", "user.approach_from_mm=30", "user.press_s=1.5",
          "user.hold_s=0.2",         "user.release_s=1.5",       "user.depth_mm=4"};
  set.insert(set.end(), more.begin(), more.end());
  return set;
}

trial::TrialResult run(const models::Setup& setup, trial::TrialOptions options) {
  trial::Trial trial(setup, std::move(options));
  return trial.run();
}

void Onlooker::see(const trial::Glance& g) {
  const Vec3 command = g.out.manipulator.tip.p();
  const double dt = g.scene.dt;
  const Vec3 velocity = ticks > 0 ? Vec3((command - command_) / dt) : Vec3::Zero();
  fastest = std::max(fastest, velocity.norm());
  hardest = std::max(hardest, (velocity - velocity_).norm() / dt);
  true_fastest = std::max(true_fastest, g.truth.tip_velocity.norm());
  true_hardest = std::max(true_hardest, g.truth.tip_acceleration.norm());
  if (g.scene.objects.size() == 1 && g.out.mode != Mode::away && entered(g))
    outside = std::max(outside, height(g));
  if (g.out.mode == Mode::hold) {
    holds += last == Mode::hold ? 0 : 1;
    held_for_ = last == Mode::hold ? held_for_ + dt : 0.0;
    // The tip stops from 50 mm/s at 0.41 m/s^2 after 0.122 s.
    if (held_for_ > 0.125) moved_in_hold = std::max(moved_in_hold, velocity.norm() * dt);
    reasons |= g.out.why & kHoldReasons;
    last_hold = g.tick.t;
    ++held;
  }
  last = g.out.mode;
  command_ = command;
  velocity_ = velocity;
  ++ticks;
}

void Onlooker::expect_within_limits() const {
  EXPECT_LE(fastest, 0.050 + 1e-9);
  EXPECT_LE(hardest, 0.41 + 1e-7);
  EXPECT_LE(true_fastest, 0.050 + 1e-9);
  EXPECT_LE(true_hardest, 0.41 + 1e-7);
}

double Onlooker::height(const trial::Glance& g) {
  const Object& ball = g.scene.objects.front();
  const double radius = std::get<Sphere>(ball.surface.shape()).radius;
  return (g.truth.tip - ball.X_WO.origin()).norm() + g.truth.tip_radius - radius;
}

bool Onlooker::entered(const trial::Glance& g) {
  entered_ = entered_ || height(g) < 0.0;
  return entered_;
}

ObservedRun look(const models::Setup& setup, trial::TrialOptions options,
                 std::function<void(const trial::Glance&)> also) {
  ObservedRun seen;
  options.watch = [&](const trial::Glance& g) {
    seen.onlooker.see(g);
    if (also) also(g);
  };
  seen.result = run(setup, std::move(options));
  return seen;
}

double force_at_limit(const models::Setup& setup, std::int32_t& contacts, double& deepest) {
  trial::PressMeasure measure(setup);
  trial::TrialOptions options;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  contacts = run(setup, options).contacts;
  const auto met = [](const trial::PressFigures& press) {
    return !std::isnan(press.miss);
  };  // not only planned
  EXPECT_EQ(std::count_if(measure.presses().begin(), measure.presses().end(), met), 1);
  deepest = measure.presses().front().peak_deflection;
  return measure.presses().front().force_at_limit;
}

}  // namespace enc::test
