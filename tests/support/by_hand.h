// step() driven by hand: ways into each mode on a ball, an arm's loop under a finger, and invalid inputs.
#pragma once

#include <array>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/time.h"
#include "core/control/stages/step_context.h"
#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc::test {

using stages::kSkin;
inline constexpr double kTipRadius = 0.005;  // m, RigSpec

[[nodiscard]] Loop make(const SceneSpec& spec, const RigSpec& rig = exact_rig());
[[nodiscard]] SceneSpec with_display();

// Puts the tool above the top with its surface `gap` over it, after the tare, with the tip waiting under it.
void wait_under(Loop& loop, double gap = 0.010);
// The tool presses with 4.05 N.
void to_contact(Loop& loop);
// A drawn surface that is 20 ms old.
void draw(Inputs& in, const Loop& loop);

void expect_within_limits(const Loop& loop);

// An arm's loop under a finger, as tests of its stages use it: the core alone, with finger and arm where the
// test puts them.
inline Scene finger_scene(const std::string& name, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  set.insert(set.end(), more.begin(), more.end());
  return trial::prepare_setup(
      models::load(fmt::format("{}/models/scenes/{}.toml", tests::source_dir(), name), "", set));
}

// A finger of 8 mm radius; `depth` is the depth of its lowest point under z = 0, negative for a gap. The tip
// follows it if it is pressed.
struct FingerBench {
  explicit FingerBench(const std::string& name, const std::vector<std::string>& more = {})
      : loop(finger_scene(name, more)) {}
  const Outputs& at(double depth, int ticks = 1, double x = 0.0) {
    for (int i = 0; i < ticks; ++i) loop.tick(Point<'W'>(x, 0.0, 0.008 - depth));
    return loop.out;
  }
  // Puts the tip `depth` under the surface, where a finger has pressed it.
  void press_tip(double depth) { put_tip({0, 0, -depth}); }
  void put_tip(const Point<'W'>& at) {
    const Impedance& law = *loop.scene.impedance();
    ArmSample& arm = loop.in.arm.value;
    ASSERT_TRUE(law.arm.inverse(loop.scene.X_WR.inverse() * at, arm.joints));
    arm.tip = law.arm.tip(arm.joints);
  }
  // Pushing force beyond gravity, N along z of W.
  [[nodiscard]] double pushed() const { return -loop.out.force_unfiltered.xyz[2]; }
  trial::FingerLoop loop;
};

// Puts an invalid value into one number of the inputs. A visitor of fields(): spoils the `wanted`-th (-1: no
// number), and counts them. `withheld` and `resumed` are skipped, because they come from no device.
struct FieldSpoiler {
  std::mt19937_64& random;
  int wanted;
  int seen = 0;
  template <class T>
  void operator()(std::string_view name, T& x) {
    if (name == "withheld" || name == "resumed" || seen++ != wanted) return;
    if constexpr (std::is_same_v<T, double>) {
      constexpr double kInf = std::numeric_limits<double>::infinity();
      const double share = std::uniform_real_distribution<double>(-0.1, 0.1)(random);
      const std::array<double, 12> bad{kUnset, kInf, -kInf, 1e12,   -1e12,  1e308,
                                       0.0,    1.0,  -1.0,  1e-300, 5e-324, x * (1.0 + share)};
      x = bad[random() % bad.size()];
    } else if constexpr (std::is_same_v<T, Time>) {
      x = Time(Duration(static_cast<std::int64_t>(random() % 2'000'000'000'000) - 1'000'000'000'000));
    } else if constexpr (std::is_same_v<T, Health>) {
      x = static_cast<Health>(random() % 6);
    } else {
      x = static_cast<T>(static_cast<std::int64_t>(random() % 2001) - 1000);
    }
  }
};

}  // namespace enc::test
