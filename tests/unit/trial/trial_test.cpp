// Whole runs, as `run` and the benchmarks make them: the same to the bit whatever the wall clock does, and
// from wherever they go on.
#include "trial/trial.h"

#include <chrono>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/record/state_hash.h"
#include "tests/unit/trial/runs.h"

namespace enc {
namespace {

using test::quick;
using test::run;
using test::scene;

// Sleeps now and then, at random: a loaded machine.
class Stalled : public Clock {
 public:
  Stalled(std::unique_ptr<Clock> clock, int& stalls) : clock_(std::move(clock)), stalls_(stalls) {}
  Tick next() override {
    if (random_() % 40 == 0) {
      ++stalls_;
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 2000));
    }
    return clock_->next();
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return clock_->missed(); }

 private:
  std::unique_ptr<Clock> clock_;
  int& stalls_;
  std::mt19937 random_{std::random_device{}()};
};

// 2 s: approach, touch at 1.35 s and the first part of a press.
trial::TrialOptions two_seconds(std::uint64_t seed = 1) {
  trial::TrialOptions options;
  options.seed = seed;
  options.seconds = 2.0;
  return options;
}

TEST(TrialHash, IsTheSameAtAnyPaceAndUnderStalls) {
  const models::Setup setup = scene("tennis_ball", quick());
  const trial::TrialResult free = run(setup, two_seconds());
  EXPECT_EQ(free.ticks, 2001);
  EXPECT_EQ(free.contacts, 1);
  EXPECT_GT(free.mode_time[static_cast<std::size_t>(Mode::contact)], 0.3);
  EXPECT_EQ(run(setup, two_seconds()).hash, free.hash);

  trial::TrialOptions paced = two_seconds();
  paced.pace = 200.0;
  EXPECT_EQ(run(setup, paced).hash, free.hash);
  paced.pace = 20.0;  // slower than the machine could: it does wait
  const trial::TrialResult slow = run(setup, paced);
  EXPECT_EQ(slow.hash, free.hash);
  EXPECT_GT(slow.wall, 0.095);  // 2 s / 20

  int stalls = 0;
  trial::TrialOptions stalled = two_seconds();
  stalled.fit_out = [&](Rig& rig) { rig.clock = std::make_unique<Stalled>(std::move(rig.clock), stalls); };
  const trial::TrialResult result = run(setup, stalled);
  EXPECT_GT(stalls, 10);
  EXPECT_EQ(result.hash, free.hash);
  EXPECT_TRUE(result.holds.empty());  // a lockstep clock is never late
}

TEST(TrialHash, AnotherSeedIsAnotherRun) {
  const models::Setup setup = scene("tennis_ball", quick());
  EXPECT_NE(run(setup, two_seconds(2)).hash, run(setup, two_seconds(1)).hash);
}

TEST(TrialHash, LookingOnChangesNothing) {
  const models::Setup setup = scene("tennis_ball", quick());
  int seen = 0;
  trial::TrialOptions watched = two_seconds();
  watched.watch = [&](const trial::Glance&) { ++seen; };
  watched.progress = [](double) {};
  EXPECT_EQ(run(setup, watched).hash, run(setup, two_seconds()).hash);
  EXPECT_EQ(seen, 2001);
}

// Times of ten hours would be 144 MB.
TEST(Trial, HoursTakeNoMoreMemoryThanMinutes) {
  trial::TrialOptions options;
  options.seconds = 36000.0;
  const trial::Trial trial(scene("tennis_ball", quick()), options);
  EXPECT_LE(trial.result().step_ns.capacity(), static_cast<std::size_t>(trial::TrialResult::kMostTimed));
}

// The devices whose samples stay in Inputs between packets, tapped for where that is: Trial gives no way to
// it.
class TappedTracker : public PoseTracker {
 public:
  TappedTracker(std::unique_ptr<PoseTracker> tracker, Stamped<TrackedTool>*& at)
      : tracker_(std::move(tracker)), at_(at) {}
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    at_ = &newest;
    return tracker_->poll(now, newest);
  }

 private:
  std::unique_ptr<PoseTracker> tracker_;
  Stamped<TrackedTool>*& at_;
};
class TappedDisplay : public Display {
 public:
  TappedDisplay(std::unique_ptr<Display> display, Stamped<DentSample>*& at)
      : display_(std::move(display)), at_(at) {}
  void show(const View& view) noexcept override { display_->show(view); }
  bool poll(Time now, Stamped<DentSample>& newest) noexcept override {
    at_ = &newest;
    return display_->poll(now, newest);
  }

 private:
  std::unique_ptr<Display> display_;
  Stamped<DentSample>*& at_;
};

// Hash over truth, state and outputs of each of the next ticks.
std::vector<std::uint64_t> trace(trial::Trial& trial, int ticks) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(trial.tick());
    StateHash hash;
    Outputs out = trial.outputs();
    add_tick(hash, trial.state(), out);
    const sim::Truth& truth = trial.world().truth();
    hash.add(leaf_bits(truth.t));
    for (const auto* triple : {&truth.tool_tip.xyz, &truth.tool_velocity.xyz, &truth.tip.xyz,
                               &truth.tip_velocity.xyz, &truth.contact_force.xyz, &truth.hand_force.xyz})
      for (const double x : *triple) hash.add(leaf_bits(x));
    all.push_back(hash.value);
  }
  return all;
}

void goes_on_from(int saved_at) {
  Stamped<TrackedTool>* tool = nullptr;
  Stamped<DentSample>* dent = nullptr;
  trial::TrialOptions options;
  options.seconds = 10.0;
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<TappedTracker>(std::move(rig.tracker), tool);
    rig.display = std::make_unique<TappedDisplay>(std::move(rig.display), dent);
  };
  trial::Trial trial(scene("tennis_ball", quick()), options);
  for (int i = 0; i < saved_at; ++i) ASSERT_TRUE(trial.tick());
  const std::vector<std::byte> world = trial.world().save();
  const State state = trial.state();
  ASSERT_TRUE(tool && dent);
  const Stamped<TrackedTool> tool_then = *tool;
  const Stamped<DentSample> dent_then = *dent;

  const std::vector<std::uint64_t> first = trace(trial, 400);
  for (int i = 0; i < 2; ++i) {  // twice: restoring may not use up what was saved
    trial.world().restore(world);
    trial.state() = state;
    *tool = tool_then;
    *dent = dent_then;
    EXPECT_EQ(trace(trial, 400), first);
  }
}

TEST(TrialSave, GoesOnTheSameFromTheApproach) { goes_on_from(900); }
TEST(TrialSave, GoesOnTheSameFromAPress) { goes_on_from(2200); }
TEST(TrialSave, GoesOnTheSameFromARelease) { goes_on_from(4300); }

}  // namespace
}  // namespace enc
