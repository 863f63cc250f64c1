// Two threads at work: one writes and one reads, one fills a record and one writes it into the file, and a
// tracker in a thread of its own.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/latest.h"
#include "core/record/record.h"
#include "trial/trackers/threaded_tracker.h"

namespace enc::trial {
namespace {

// ---- One thread writes and one reads, at full speed.

// Too long for one copy instruction: a torn value has two numbers in it.
struct LongValue {
  std::array<std::int64_t, 32> same{};
  [[nodiscard]] bool whole() const {
    return std::all_of(same.begin(), same.end(), [this](std::int64_t n) { return n == same[0]; });
  }
};

TEST(LatestOfTwoThreads, IsWholeAndNeverGoesBackAndEndsWithTheLast) {
  constexpr std::int64_t kWrites = 300'000;
  LatestValue<LongValue> latest;
  std::atomic<bool> reads = false, over = false;
  std::thread writer([&] {
    while (!reads) std::this_thread::yield();
    LongValue value;
    for (std::int64_t n = 1; n <= kWrites; ++n) {
      value.same.fill(n);
      latest.write(value);
    }
    over = true;
  });
  std::int64_t last = 0, torn = 0, older = 0, read = 0;
  LongValue value;
  for (bool end = false; !end;) {
    reads = true;
    end = over;  // before the last look
    while (latest.read(value)) {
      ++read;
      torn += value.whole() ? 0 : 1;
      older += value.same[0] <= last ? 1 : 0;
      last = value.same[0];
    }
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(older, 0);
  EXPECT_EQ(last, kWrites);
  EXPECT_GT(read, 0);
}

// ---- One thread fills a record and another writes it into the file.

TEST(RecordOfTwoThreads, IsWholeAndInOrder) {
  constexpr std::int64_t kTicks = 20'000;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("threads_" + std::to_string(getpid()) + ".encrec")).string();
  {
    RecordWriter record(path, {}, layout_hash(Scene()), 64);  // wraps around five times
    std::atomic<bool> over = false;
    std::thread file([&] {
      while (!over) record.drain();
    });
    for (std::int64_t i = 0; i < kTicks && !record.full(); ++i) {
      record.write({i, Time(Duration(i)), Duration(1)}, {}, {}, 0);
      if (i % 100 == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the pace of a loop of 50 kHz
    }
    over = true;
    file.join();
    record.close();
    EXPECT_EQ(record.error(), "");
  }
  RecordReader reader(path);
  RecordedTick got;
  std::int64_t read = 0;
  for (; reader.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, kTicks);
  std::filesystem::remove(path);
}

// ---- A tracker in a thread of its own: the loop never waits, every state gets through, and the thread ends
// at once.

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }

// The tracker's next report and the duration of its work. A test changes them only while the thread rests.
struct Script {
  std::atomic<bool> open = true;  // closed: it works until it is opened
  std::atomic<int> asked = 0;
  std::atomic<bool> up = true;
  std::atomic<Health> health = Health::ok;
  std::atomic<bool> silent = false;
};
class ScriptedTracker final : public PoseTracker {
 public:
  explicit ScriptedTracker(Script& script) : script_(script) {}
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
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
  std::vector<std::string> lines_;  // belongs to the polling thread
};

struct Set {
  Script script;
  ThreadedTracker tracker{std::make_unique<ScriptedTracker>(script)};
  Measurement<TrackedTool> newest;
  std::int64_t ms = 0;
  ~Set() { script.open = true; }

  bool poll() { return tracker.poll(at_ms(++ms), newest); }
  // Polls like the loop until `is` holds; returns false after ten seconds.
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
  set.poll();  // fetches the last report
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

// Options for ThreadSanitizer. By default it orders every receive from any socket after all sends on any
// other. It would so miss races between two threads that both use a network. Only the sanitizer calls this
// function, by its name.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_options() { return "io_sync=0"; }
