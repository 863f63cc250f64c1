// An arm's loop under a finger, as tests of its stages use it: the core alone, finger and arm are where a
// test puts them.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc::test {

inline Scene finger_scene(const std::string& name, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  set.insert(set.end(), more.begin(), more.end());
  return trial::prepare_setup(
      models::load(fmt::format("{}/models/scenes/{}.toml", tests::source_dir(), name), "", set));
}

// A finger of 8 mm radius; `depth` of its lowest point under z = 0, negative: the gap. The tip goes there,
// too, if it is pressed.
struct FingerBench {
  explicit FingerBench(const std::string& name, const std::vector<std::string>& more = {})
      : loop(finger_scene(name, more)) {}
  const Outputs& at(double depth, int ticks = 1, double x = 0.0) {
    for (int i = 0; i < ticks; ++i) loop.tick(Point<'W'>(x, 0.0, 0.008 - depth));
    return loop.out;
  }
  // The tip `depth` under the surface, where a finger has pressed it.
  void press_tip(double depth) { put_tip({0, 0, -depth}); }
  void put_tip(const Point<'W'>& at) {
    const Impedance& law = *loop.scene.impedance();
    ArmSample& arm = loop.in.arm.value;
    ASSERT_TRUE(law.arm.inverse(loop.scene.X_WR.inverse() * at, arm.joints));
    arm.tip = law.arm.tip(arm.joints);
  }
  // What is pushed with beyond gravity, N along z of W.
  [[nodiscard]] double pushed() const { return -loop.out.felt.xyz[2]; }
  trial::FingerLoop loop;
};

}  // namespace enc::test
