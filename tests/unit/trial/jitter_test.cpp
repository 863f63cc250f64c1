// What vision changes of what is felt: a wall, pressed by a finger that is seen at 20 Hz, with results that
// come up to a frame early or late, beside the same with results that come when they are due; and with a
// picture, beside the same without it.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "trial/measure/felt_apart.h"
#include "trial/measure/frame_force.h"
#include "trial/trackers/jittered_tracker.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

constexpr Duration kFrame{50'000'000};
constexpr std::size_t kFrameTicks = 50;
constexpr double kForceStep = 0.2;  // N, between frames

// Without a latency of its own, so that a result can be early.
FeltWay press(Duration jitter, std::uint64_t seed) {
  FeltWay way;
  TrialOptions options;
  options.seed = seed;
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<JitteredTracker>(std::move(rig.tracker),
                                                    JitteredTracker::Spec{kFrame, jitter, seed});
  };
  options.watch = [&](const Glance& glance) { way.see(glance); };
  Trial(models::load(tests::source_dir() + "/models/scenes/wall.toml", "",
                     {"truth.tracker.latency_ms=0", "user.approach_mm_s=[100]", "user.rest_s=1"}),
        options)
      .run();
  return way;
}

TEST(Jitter, OfAFrameChangesNothingThatIsFeltByMoreThanTheForceStep) {
  for (int i = 1; i <= tests::thorough(1, 4); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const FeltApart apart = felt_apart(press({}, seed), press(kFrame, seed), kFrameTicks);
    EXPECT_GT(apart.ticks, 6000U) << seed;
    EXPECT_GT(apart.tick, 0.0) << seed;
    EXPECT_LE(apart.frame, kForceStep) << seed;
  }
}

// Eight frames late the finger is lost: what is felt is another thing, and the measure shows it.
TEST(Jitter, OfEightFramesIsFelt) {
  EXPECT_GT(felt_apart(press({}, 1), press(8 * kFrame, 1), kFrameTicks).frame, 1.0);
}

struct Pressed {
  FrameForce frames;
  double too_deep = 0.0;  // m, of what the core believes beyond what is true
  TrialResult result;
};
Pressed press_fast(std::uint64_t seed, bool beside = true) {
  Pressed pressed;
  TrialOptions options;
  options.seed = seed;
  if (beside)
    options.law = [&](const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
      pressed.frames.step(scene, tick, in, state, out);
    };
  options.watch = [&](const Glance& glance) {
    if (glance.out.mode != Mode::contact || !glance.truth.touching) return;
    const double deep = glance.truth.tool_radius - glance.truth.tool_tip.xyz[2];
    pressed.too_deep = std::max(pressed.too_deep, glance.out.deflection - deep);
  };
  pressed.result = Trial(models::load(tests::source_dir() + "/models/scenes/wall.toml", "",
                                      {"user.approach_mm_s=[200, 300]", "user.press_s=0.6", "user.hold_s=0.3",
                                       "user.release_s=0.4", "user.rest_s=1", "user.depth_mm=5"}),
                         options)
                       .run();
  return pressed;
}

// A finger that comes fast is stopped by the prop 100 ms before a picture shows it. Carried on with what the
// pictures say it would be 20 mm deep, and lost when they say otherwise.
// With seed 12 pictures leap to the side, too, while it is pressed.
TEST(FrameForce, APictureInContactIsNotFelt) {
  for (const std::uint64_t seed : {1U, 2U, 12U}) {
    const Pressed pressed = press_fast(seed);
    EXPECT_GT(pressed.frames.changes().size(), 40U);
    EXPECT_LE(greatest_change(pressed.frames.changes(), true), kForceStep) << seed;
    EXPECT_GT(greatest_change(pressed.frames.changes(), false), 0.0) << seed;  // of when the touch begins
    EXPECT_LT(pressed.too_deep, 1e-3) << seed;
    EXPECT_EQ(pressed.result.hash, press_fast(seed, false).result.hash) << "the second core disturbs it";
  }
  EXPECT_TRUE(std::isnan(greatest_change({{true, 0.1}}, false)));
  EXPECT_TRUE(std::isnan(greatest_change({{true, 0.1}, {true, kUnset}, {true, 0.2}}, true)));
  EXPECT_EQ(greatest_change({{true, 0.1}, {false, kUnset}, {true, 0.2}}, true), 0.2);
}

// Five ticks, one of them not in contact: two whole frames of two ticks, that of 4 N and 0 and that of 1 N
// and -1 N.
TEST(FeltApart, IsOfTicksInWhichBothAreInContactAndOfWholeFramesOfThem) {
  const auto way = [](const std::vector<double>& newtons) {
    const Scene scene;
    const sim::Truth truth;
    FeltWay made;
    for (const double n : newtons) {
      Outputs out;
      out.mode = std::isnan(n) ? Mode::follow : Mode::contact;
      out.force = Vec<'N'>(0, 0, n);
      made.see({scene, Tick{}, truth, Inputs{}, out});
    }
    return made;
  };
  const FeltApart apart = felt_apart(way({-5, -5, -5, -5, -5}), way({-5, -9, kUnset, -6, -4}), 2);
  EXPECT_EQ(apart.ticks, 4U);
  EXPECT_DOUBLE_EQ(apart.tick, 4.0);
  EXPECT_DOUBLE_EQ(apart.frame, 2.0);  // of the first two
}

}  // namespace
}  // namespace enc::trial
