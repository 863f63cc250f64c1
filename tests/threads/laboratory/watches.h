// What a loop sees of each device, tick by tick: whether a number is torn, time goes back, or who has lost
// its link is believed.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "core/devices/force_sensor.h"
#include "core/devices/manipulator.h"
#include "core/devices/pose_tracker.h"
#include "tests/threads/laboratory/faulty_places.h"

namespace enc::test {

class Watch {
 public:
  // While the loop goes on:
  [[nodiscard]] bool lost() const { return lost_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t news() const { return news_.load(std::memory_order_relaxed); }  // that are good
  // When it is over:
  void expect_whole() const {
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(older, 0);
    EXPECT_EQ(ahead, 0);
    EXPECT_EQ(back, 0) << "a link that was lost stays so";
    EXPECT_EQ(believed, 0) << "without a link";
  }
  int torn = 0, older = 0, ahead = 0, back = 0, believed = 0, smaller = 0;

 protected:
  // Before it is read. A link may be lost between.
  void before(const Device& device) {
    linked_ = device.linked();
    back += linked_ && lost() ? 1 : 0;
    if (!linked_) lost_.store(true, std::memory_order_relaxed);
    constexpr int kSometimes = 16;
    if (++asked_ % kSometimes == 0) static_cast<void>(device.remarks());
  }
  // number: of what counts, it only grows.
  void after(Time now, Time t, Health health, bool whole, std::int64_t number) {
    ahead += t > now ? 1 : 0;
    older += t < last_ ? 1 : 0;
    const bool good = health == Health::ok;
    believed += good && !linked_ ? 1 : 0;
    torn += good && !whole ? 1 : 0;
    smaller += good && number < number_ ? 1 : 0;
    if (good) number_ = number;
    if (good && t > last_) news_.fetch_add(1, std::memory_order_relaxed);
    last_ = t;
  }

 private:
  bool linked_ = true;
  int asked_ = 0;
  std::int64_t number_ = 0;
  Time last_ = Time::min();
  std::atomic<bool> lost_ = false;
  std::atomic<std::int64_t> news_ = 0;
};

// It tells, too: to and fro along the diagonal of x and y.
struct MachineWatch : Watch {
  explicit MachineWatch(Manipulator& device, bool tells = true) : machine(device), told(tells) {}
  void tick(Time now) {
    before(machine);
    const Stamped<TipSample> sample = machine.read(now);
    const Vec3 p = sample.value.X_RH.p(), v = sample.value.velocity.e();
    after(now, sample.t, sample.health, p.x() == p.y() && v.x() == v.y(), 0);
    farthest = std::max(farthest, std::abs(p.x()));
    constexpr double kFar = 2e-3, kTurn = 0.02;  // m, rad in a tick
    const double x = kFar * std::sin(kTurn * static_cast<double>(++ticks));
    if (told) machine.command(Pose<'R', 'H'>(zero.q(), Vec3(zero.p() + Vec3(x, x, 0))));
  }

  Manipulator& machine;
  Pose<'R', 'H'> zero = machine.reach().machine.zero();
  bool told;
  std::int64_t ticks = 0;
  double farthest = 0.0;
};

struct SensorWatch : Watch {
  explicit SensorWatch(ForceSensor& device) : sensor(device) {}
  void tick(Time now) {
    before(sensor);
    const auto [wrench, t, health] = sensor.read(now);
    const double x = wrench.force.xyz[0];
    bool whole = true;
    for (std::size_t i = 0; i < 3; ++i)
      whole = whole && wrench.force.xyz[i] == x && wrench.torque.xyz[i] == x;
    after(now, t, health, whole, std::llround(x / CountingSensor::kStep));
  }
  ForceSensor& sensor;
};

struct TrackerWatch : Watch {
  explicit TrackerWatch(PoseTracker& device) : tracker(device) {}
  void tick(Time now) {
    before(tracker);
    Stamped<TrackedTool> newest;
    if (!tracker.poll(now, newest)) return;
    const Vec3 p = newest.value.X_CT.p();
    after(now, newest.t, newest.health, p.x() == p.y() && newest.value.tool == 0,
          std::llround(p.x() / CountingTracker::kStep));
  }
  PoseTracker& tracker;
};

}  // namespace enc::test
