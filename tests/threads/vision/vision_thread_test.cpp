// Vision with a camera in wall time, in a thread of its own beside a loop of 1 kHz.
#include <chrono>
#include <thread>

#include <gmock/gmock.h>

#include "core/vision/vision_tracker.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"
#include "trial/trackers/frame_times.h"
#include "trial/trackers/threaded_tracker.h"

namespace enc::trial {
namespace {

using drawn::HandAt;
using Wall = std::chrono::steady_clock;

StereoRig tiny() {
  StereoRig rig;
  rig.width = 160;
  rig.height = 120;
  rig.left = rig.right = {180.25, 180.25, 79.5, 59.5, {}};
  return rig;
}

// Drawn once for all tests.
struct Pictures {
  HandAt hand;
  drawn::Pair room, seen;
  Pictures() {
    hand.tip = {0.06, 0.01, 0.45};
    room = drawn::pair_of(tiny(), nullptr, 5);
    seen = drawn::pair_of(tiny(), &hand);
  }
};
const Pictures& pictures() {
  static const Pictures kAll;
  return kAll;
}

// Controls of the camera while it works.
struct Switches {
  std::atomic<bool> up = true, running = true;
  std::atomic<int> works_ms = 0;  // extra duration of a poll with a frame
};

// Exposes at 50 Hz of the polled time; the first frames show no hand.
class LiveCamera final : public StereoCamera {
 public:
  explicit LiveCamera(Switches& switches) : switches_(switches) {}
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    bool due = false;
    while (exposures_.due(now)) due = true;
    if (!due || !switches_.running) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(switches_.works_ms.load()));
    const drawn::Pair& pair = ++frames_ > 3 ? pictures().seen : pictures().room;
    newest = {pair.frame(), now, Health::ok};
    return true;
  }
  [[nodiscard]] bool linked() const noexcept override { return switches_.up; }
  [[nodiscard]] std::string describe() const override { return "drawn pairs"; }
  [[nodiscard]] std::vector<std::string> remarks() const override {
    return {std::to_string(frames_) + " frames"};
  }

 private:
  Switches& switches_;
  DueTimes exposures_{50.0};
  int frames_ = 0;
};

std::unique_ptr<PoseTracker> vision(Switches& switches) {
  StereoRig rig = tiny();
  rig.rate = 50.0;
  return std::make_unique<VisionTracker>(std::make_unique<LiveCamera>(switches), rig,
                                         FingerTracker(tiny(), drawn::segmentation(), {}, {}),
                                         Release::when_done);
}

// A haptic loop of 1 kHz in wall time that only polls.
struct Loop {
  Switches switches;
  ThreadedTracker tracker{vision(switches)};
  Measurement<TrackedTool> newest;
  FrameTimes times;
  Wall::time_point start = Wall::now();
  double longest_poll = 0.0;  // s

  Time now() const { return Time(std::chrono::duration_cast<Duration>(Wall::now() - start)); }
  void tick() {
    const Wall::time_point before = Wall::now();
    const Time t = now();
    tracker.poll(t, newest);
    longest_poll = std::max(longest_poll, std::chrono::duration<double>(Wall::now() - before).count());
    times.see(t, newest);
    std::this_thread::sleep_until(before + std::chrono::milliseconds(1));
  }
  template <class F>
  bool until(const F& is) {
    const Wall::time_point end = Wall::now() + std::chrono::seconds(20);
    while (Wall::now() < end) {
      tick();
      if (is()) return true;
    }
    return false;
  }
  double seconds_to_last() const { return seconds(times.last - Time{}); }
  bool sees() const { return newest.health == Health::ok && newest.value.tool == VisionTracker::kFinger; }
};

TEST(VisionThread, TheFingerIsSeenBesideTheLoop) {
  Loop loop;
  loop.times.reserve(1000);
  ASSERT_TRUE(loop.until([&] { return loop.times.frames >= 60 && loop.sees(); }));
  EXPECT_LT((loop.newest.value.X_CT.p() - pictures().hand.tip).norm(), 4e-3);
  // Never more frames than were due since the start. (Their rate says less: a late first frame makes the
  // others look fast.)
  EXPECT_LE(static_cast<double>(loop.times.frames), 1.0 + 50.0 * loop.seconds_to_last());
  for (const double age : loop.times.ages) EXPECT_GE(age, 0.0);
  EXPECT_THAT(loop.tracker.remarks().front(), testing::HasSubstr("frames"));
}

TEST(VisionThread, ACameraThatStallsAndComesBackAndLosesItsLink) {
  Loop loop;
  ASSERT_TRUE(loop.until([&] { return loop.sees(); }));
  loop.switches.running = false;
  ASSERT_TRUE(loop.until([&] { return loop.newest.health == Health::stale; }));
  loop.switches.running = true;
  ASSERT_TRUE(loop.until([&] { return loop.sees(); }));
  loop.switches.up = false;
  ASSERT_TRUE(loop.until([&] { return !loop.tracker.linked(); }));
  loop.switches.up = true;
  ASSERT_TRUE(loop.until([&] { return loop.tracker.linked(); }));
}

// A frame costs ten ticks and more: the frames become fewer, the ticks do not.
TEST(VisionThread, ASlowCameraKeepsNobody) {
  Loop loop;
  loop.switches.works_ms = 60;
  const std::int64_t frames = 6;
  std::int64_t ticks = 0;
  ASSERT_TRUE(loop.until([&] { return ++ticks > 0 && loop.times.frames >= frames; }));
  EXPECT_GT(ticks, 10 * frames);
  EXPECT_LE(static_cast<double>(loop.times.frames), loop.seconds_to_last() / 0.06);
}

TEST(VisionThread, StartsAndEndsFiftyTimes) {
  for (int i = 0; i < 50; ++i) {
    Loop loop;
    for (int ticks = 0; ticks < i % 8; ++ticks) loop.tick();
  }
}

}  // namespace
}  // namespace enc::trial
