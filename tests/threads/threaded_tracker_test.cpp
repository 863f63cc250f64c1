// A tracker in a thread of its own: the loop is never kept, every state gets through, and it ends at once.
#include "trial/trackers/threaded_tracker.h"

#include <chrono>
#include <thread>

#include <gmock/gmock.h>

namespace enc::trial {
namespace {

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }

// What it says next, and for how long it works on it. A test changes the words only while the thread rests.
struct Script {
  std::atomic<bool> open = true;  // closed: it works until it is opened
  std::atomic<int> asked = 0;
  std::atomic<bool> up = true;
  std::atomic<Health> health = Health::ok;
  std::atomic<bool> silent = false;
};
class Scripted final : public PoseTracker {
 public:
  explicit Scripted(Script& script) : script_(script) {}
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    ++script_.asked;
    while (!script_.open) std::this_thread::sleep_for(std::chrono::microseconds(100));
    if (script_.silent) return false;
    newest = {
        {static_cast<std::int32_t>(now.time_since_epoch().count() / 1'000'000), {}}, now, script_.health};
    lines_ = {"asked"};
    return true;
  }
  [[nodiscard]] bool linked() const noexcept override { return script_.up; }
  [[nodiscard]] std::string describe() const override { return "a script"; }
  [[nodiscard]] std::vector<std::string> remarks() const override { return lines_; }

 private:
  Script& script_;
  std::vector<std::string> lines_;  // of whoever polls
};

struct Set {
  Script script;
  ThreadedTracker tracker{std::make_unique<Scripted>(script)};
  Stamped<TrackedTool> newest;
  std::int64_t ms = 0;
  ~Set() { script.open = true; }

  bool poll() { return tracker.poll(at_ms(++ms), newest); }
  // Polls as the loop does until `is`; false where that takes more than ten seconds.
  template <class F>
  bool until(const F& is) {
    for (int i = 0; i < 10'000; ++i) {
      poll();
      if (is()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
};

TEST(ThreadedTracker, TellsWhatTheTrackerToldWithItsStampAndNeverGoesBack) {
  Set set;
  int news = 0;
  std::int64_t wrong = 0;
  Time before = Time::min();
  EXPECT_TRUE(set.until([&] {
    const bool newer = set.newest.health == Health::ok && set.newest.t > before;
    wrong += set.newest.health == Health::ok && set.newest.t < before ? 1 : 0;
    wrong += newer && at_ms(set.newest.value.tool) != set.newest.t ? 1 : 0;
    news += newer ? 1 : 0;
    before = std::max(before, set.newest.t);
    return news == 300;
  }));
  EXPECT_EQ(wrong, 0);
}

TEST(ThreadedTracker, HealthAndLinkGetThrough) {
  Set set;
  for (const Health health : {Health::stale, Health::fault, Health::ok, Health::absent, Health::ok}) {
    set.script.health = health;
    EXPECT_TRUE(set.until([&] { return set.newest.health == health; }));
  }
  for (const bool up : {false, true, false}) {
    set.script.up = up;
    EXPECT_TRUE(set.until([&] { return set.tracker.linked() == up; }));
  }
}

TEST(ThreadedTracker, WithoutNewsTheSampleIsLeftAlone) {
  Set set;
  ASSERT_TRUE(set.until([&] { return set.newest.health == Health::ok; }));
  set.script.silent = true;
  const int asked = set.script.asked;
  ASSERT_TRUE(set.until([&] { return set.script.asked > asked + 3; }));
  set.poll();  // fetches what was told last
  const Time last = set.newest.t;
  set.newest.value.tool = -77;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(set.poll());
  EXPECT_EQ(set.newest.value.tool, -77);
  EXPECT_EQ(set.newest.t, last);
}

// If poll() waited for the tracker, this would not end.
TEST(ThreadedTracker, TheLoopGoesOnWhileTheTrackerWorksAndAThreadThatDoesNotComeBackIsALostLink) {
  Set set;
  ASSERT_TRUE(set.until([&] { return set.newest.health == Health::ok; }));
  set.script.open = false;
  const int asked = set.script.asked;
  ASSERT_TRUE(set.until([&] { return set.script.asked > asked; }));
  set.poll();
  for (std::uint32_t i = 0; i < ThreadedTracker::kPatience - 20; ++i) EXPECT_FALSE(set.poll());
  EXPECT_TRUE(set.tracker.linked());
  for (std::uint32_t i = 0; i < 20; ++i) set.poll();
  EXPECT_FALSE(set.tracker.linked());
  set.script.open = true;
  const Time before = set.newest.t;
  EXPECT_TRUE(set.until([&] { return set.tracker.linked() && set.newest.t > before; }));
}

TEST(ThreadedTracker, WhatItSaysOfItselfIsSafeToReadWhileItWorks) {
  Set set;
  for (int i = 0; i < 200; ++i) {
    set.poll();
    std::this_thread::sleep_for(std::chrono::microseconds(100));  // it works by now, or has worked
    (void)set.tracker.remarks();
    EXPECT_EQ(set.tracker.describe(), "a script, in a thread of its own");
  }
  ASSERT_TRUE(set.until([&] { return set.newest.health == Health::ok; }));
  EXPECT_THAT(set.tracker.remarks(), testing::ElementsAre("asked"));
}

TEST(ThreadedTracker, StartsAndEndsFiftyTimesWhateverItIsAt) {
  for (int i = 0; i < 50; ++i) {
    Set set;
    for (int polls = 0; polls < i % 4; ++polls) set.poll();
    if (i % 3 == 0) continue;
    set.script.open = false;
    set.poll();
  }
}

}  // namespace
}  // namespace enc::trial
