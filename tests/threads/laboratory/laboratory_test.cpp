// The laboratory's drivers, each beside threads of faulty fakes: the machine, the datagrams, and the whole
// rig in one loop.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/devices/device.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/clocks.h"
#include "tests/threads/laboratory/faulty_places.h"

namespace enc::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = Trouble::Kind;

// ---- The loop's view of each device, tick by tick: torn numbers, time that goes back, or samples accepted
// without a link.

class Watch {
 public:
  // While the loop runs:
  [[nodiscard]] bool lost() const { return lost_.load(std::memory_order_relaxed); }
  // Number of good samples.
  [[nodiscard]] std::int64_t news() const { return news_.load(std::memory_order_relaxed); }
  // After the loop:
  void expect_whole() const {
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(older, 0);
    EXPECT_EQ(ahead, 0);
    EXPECT_EQ(back, 0) << "a link that was lost stays so";
    EXPECT_EQ(believed, 0) << "without a link";
  }
  int torn = 0, older = 0, ahead = 0, back = 0, believed = 0, smaller = 0;

 protected:
  // Called before the read. The link may be lost in between.
  void before(const Device& device) {
    linked_ = device.linked();
    back += linked_ && lost() ? 1 : 0;
    if (!linked_) lost_.store(true, std::memory_order_relaxed);
    constexpr int kSometimes = 16;
    if (++asked_ % kSometimes == 0) static_cast<void>(device.remarks());
  }
  // number: from a counting device; it only grows.
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

// Commands the machine, too: to and fro along the diagonal of x and y.
struct MachineWatch : Watch {
  explicit MachineWatch(Manipulator& device, bool tells = true) : machine(device), told(tells) {}
  void tick(Time now) {
    before(machine);
    const Measurement<TipSample> sample = machine.read(now);
    const Vec3 p = sample.value.X_RH.p(), v = sample.value.velocity.e();
    after(now, sample.t, sample.health, p.x() == p.y() && v.x() == v.y(), 0);
    farthest = std::max(farthest, std::abs(p.x()));
    constexpr double kFar = 2e-3, kTurn = 0.02;  // m, rad per tick
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
    Measurement<TrackedTool> newest;
    if (!tracker.poll(now, newest)) return;
    const Vec3 p = newest.value.X_CT.p();
    after(now, newest.t, newest.health, p.x() == p.y() && newest.value.tool == 0,
          std::llround(p.x() / CountingTracker::kStep));
  }
  PoseTracker& tracker;
};

// ---- Fakes that a thread of their own serves in wall time. This thread injects faults between two turns, as
// `encounter fake` does: a fake may be used by one thread only.

constexpr std::array<Trouble::Kind, 11> kAllTroubles{
    Trouble::Kind::loss,     Trouble::Kind::jitter,     Trouble::Kind::reorder,   Trouble::Kind::duplicate,
    Trouble::Kind::stall,    Trouble::Kind::disconnect, Trouble::Kind::garbage,   Trouble::Kind::half_message,
    Trouble::Kind::saturate, Trouble::Kind::error_code, Trouble::Kind::slow_start};

class FaultyFakes {
 public:
  explicit FaultyFakes(std::vector<Fake*> fakes) : fakes_(std::move(fakes)) {}
  ~FaultyFakes() { end(); }
  FaultyFakes(const FaultyFakes&) = delete;
  FaultyFakes& operator=(const FaultyFakes&) = delete;

  // These functions return when the fault is injected; only one other thread may call them.
  void suffer(Fake& fake, const Trouble& trouble) {
    between_turns([&] { fake.suffer(trouble); });
  }
  void heal(Fake& fake, Trouble::Kind kind) {
    between_turns([&] { fake.heal(kind); });
  }
  void heal(Fake& fake) {
    between_turns([&] {
      for (const Trouble::Kind kind : kAllTroubles)
        if (fake.knows({kind})) fake.heal(kind);
    });
  }
  // Ends the serving thread, as if the program had stopped.
  void end() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void between_turns(const std::function<void()>& work) {
    std::unique_lock lock(mutex_);
    work_ = &work;
    done_.wait(lock, [this] { return work_ == nullptr; });
  }
  void work() {
    const std::lock_guard lock(mutex_);
    if (work_ == nullptr) return;
    (*work_)();
    work_ = nullptr;
    done_.notify_one();
  }
  void serve() {
    while (!over_) {
      work();
      const Time now(net::steady_now());
      for (Fake* const fake : fakes_) fake->serve(now);
      for (Fake* const fake : fakes_) fake->publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  std::vector<Fake*> fakes_;
  std::atomic<bool> over_ = false;
  std::mutex mutex_;
  std::condition_variable done_;
  const std::function<void()>* work_ = nullptr;  // under the mutex
  std::thread thread_{[this] { serve(); }};
};

// ---- A loop of 1 kHz in a thread of its own. Observing it from outside orders nothing between threads: a
// stricter wait would hide data races from ThreadSanitizer.

// Waits until a condition holds; returns false after a minute.
template <class What>
bool comes_true(const What& what) {
  for (int i = 0; i < 60'000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return what();
}

template <class Ticks>
class LoopThread {
 public:
  // The loop's thread calls ticks.tick(now).
  explicit LoopThread(Ticks& ticks) : ticks_(ticks), thread_([this] { run(); }) {}
  ~LoopThread() { end(); }
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  void end() {
    over_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
  }
  // Returns after so many more ticks.
  void pass(std::int64_t ticks) const {
    const std::int64_t until = made() + ticks;
    static_cast<void>(comes_true([&] { return made() >= until; }));
  }
  [[nodiscard]] std::int64_t made() const { return made_.load(std::memory_order_relaxed); }

 private:
  void run() {
    for (const Duration begun = net::steady_now(); !over_.load(std::memory_order_relaxed);) {
      ticks_.tick(Time(net::steady_now() - begun));
      made_.fetch_add(1, std::memory_order_relaxed);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Ticks& ticks_;
  std::atomic<bool> over_ = false;
  std::atomic<std::int64_t> made_ = 0;
  std::thread thread_;
};

// ---- The driver of the C-887, whose link has a thread, between the loop and a faulty controller.

TEST(ThreadedMachine, KeepsItsLinkThroughWhatHealsAndTearsNoNumber) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  fakes.suffer(*there.server, {Kind::slow_start, 0.05});
  const auto driver = there.driver();
  fakes.heal(*there.server, Kind::slow_start);
  MachineWatch watch(*driver);
  LoopThread loop(watch);
  for (int i = 0; i < 25; ++i) {
    const Trouble trouble = i % 2 == 0 ? Trouble{Kind::jitter, 0.003} : Trouble{Kind::stall};
    fakes.suffer(*there.server, trouble);
    loop.pass(15);
    fakes.heal(*there.server, trouble.kind);
    loop.pass(5);
  }
  const std::int64_t before = watch.news();
  EXPECT_TRUE(comes_true([&] { return watch.news() > before + 20; }));
  loop.end();
  watch.expect_whole();
  EXPECT_TRUE(driver->linked());
  EXPECT_GT(watch.farthest, 1e-4) << "it moves";
  EXPECT_THAT(there.log.lines(), IsEmpty());
}

struct LastFault {
  Trouble trouble;
  double patience;    // s
  const char* words;  // reason of the lost link
};
void expect_end_by(const LastFault& fault) {
  FaultyGcs there(fault.patience);
  FaultyFakes fakes({there.server.get()});
  auto driver = there.driver();
  MachineWatch watch(*driver);
  LoopThread loop(watch);
  loop.pass(20);
  fakes.suffer(*there.server, fault.trouble);
  EXPECT_TRUE(comes_true([&] { return watch.lost(); }));
  fakes.heal(*there.server);
  loop.pass(20);
  loop.end();
  watch.expect_whole();
  EXPECT_FALSE(driver->linked());
  EXPECT_NE(driver->read(Time{}).health, Health::ok);
  driver.reset();  // its thread has logged everything by then
  EXPECT_THAT(there.log.lines(), Contains(HasSubstr(fault.words)));
}

// A fault that may leave an answer without its end has a short patience.
TEST(ThreadedMachine, AFaultThatEndsTheLinkIsSeenByTheLoopAndIsForGood) {
  constexpr int kFailure = 504;
  for (const LastFault& fault :
       {LastFault{{Kind::stall}, kImpatient, "lost: no answer in time"},
        LastFault{{Kind::disconnect}, kPatient, "lost: closed by the controller"},
        LastFault{{Kind::error_code, kFailure}, kPatient, "lost: a fault of the machine"},
        LastFault{{Kind::half_message, 1.0}, kImpatient, "lost: "},
        LastFault{{Kind::garbage, 1.0}, kImpatient, "lost: "}}) {
    SCOPED_TRACE(static_cast<int>(fault.trouble.kind));
    expect_end_by(fault);
  }
}

// Ends the driver while its controller is in the state that `meets` leaves, which the driver may not have
// noticed yet.
using Meets = std::function<void(FaultyGcs& there, FaultyFakes& fakes)>;
void end_after(const Meets& meets, bool told) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  auto driver = there.driver();
  MachineWatch watch(*driver, told);
  LoopThread loop(watch);
  loop.pass(15);
  meets(there, fakes);
  loop.end();
  driver.reset();
  watch.expect_whole();
}
Meets suffering(const Trouble& trouble) {
  return [=](FaultyGcs& there, FaultyFakes& fakes) { fakes.suffer(*there.server, trouble); };
}
void nothing(FaultyGcs&, FaultyFakes&) {}
void left_alone(FaultyGcs&, FaultyFakes& fakes) { fakes.end(); }
void gone(FaultyGcs& there, FaultyFakes& fakes) {
  fakes.end();
  there.server.reset();
}

TEST(ThreadedMachine, EndsInEveryState) {
  for (const bool told : {false, true}) {
    end_after(nothing, told);
    end_after(suffering({Kind::jitter, 0.1}), told);
    end_after(suffering({Kind::stall}), told);
    end_after(suffering({Kind::disconnect}), told);
    end_after(suffering({Kind::garbage, 1.0}), told);
    end_after(gone, told);
  }
  end_after(left_alone, true);
}

// The thread may not have had its first turn.
TEST(ThreadedMachine, EndsAsSoonAsItHasBegun) {
  FaultyGcs there(kPatient);
  FaultyFakes fakes({there.server.get()});
  static_cast<void>(there.driver());
  const auto driver = there.driver();
  driver->stop();
  MachineWatch watch(*driver);
  watch.tick(Time{});
  fakes.suffer(*there.server, {Kind::disconnect});
  EXPECT_THAT(there.log_of_fake.lines(),
              ElementsAre(HasSubstr("the client is gone"), HasSubstr("the client is gone")));
}

// ---- The drivers that read datagrams within the loop, beside a thread that sends them with faults.

struct NetftKit {
  using Place = FaultyNetft;
  using WatchType = SensorWatch;
};
struct IgtlKit {
  using Place = FaultyIgtl;
  using WatchType = TrackerWatch;
};

template <class Kit>
struct ThreadedDatagrams : testing::Test {
  using Place = typename Kit::Place;
  using WatchType = typename Kit::WatchType;

  // Injects one fault after the other, each for some ticks, for half a second.
  static void suffer(Place& there, FaultyFakes& fakes, const LoopThread<WatchType>& loop,
                     const std::vector<Trouble>& all) {
    for (std::size_t i = 0; i < 25; ++i) {
      const Trouble& trouble = all[i % all.size()];
      if (!there.server->knows(trouble)) continue;
      fakes.suffer(*there.server, trouble);
      loop.pass(15);
      if (i % 4 != 0) fakes.heal(*there.server, trouble.kind);  // otherwise it lasts
      loop.pass(5);
    }
    fakes.heal(*there.server);
  }
  // Expects new samples afterwards, undamaged samples throughout, and a link. Returns how often a number was
  // smaller than the one before.
  static int expect_to_go_on_after(const std::vector<Trouble>& all) {
    Place there(kPatient);
    FaultyFakes fakes({there.server.get()});
    const auto driver = there.driver();
    WatchType watch(*driver);
    LoopThread loop(watch);
    suffer(there, fakes, loop, all);
    const std::int64_t before = watch.news();
    EXPECT_TRUE(comes_true([&] { return watch.news() > before + 20; }));
    loop.end();
    watch.expect_whole();
    EXPECT_TRUE(driver->linked());
    return watch.smaller;
  }
};
using Kits = testing::Types<NetftKit, IgtlKit>;
TYPED_TEST_SUITE(ThreadedDatagrams, Kits);

TYPED_TEST(ThreadedDatagrams, GoForwardThroughWhatHeals) {
  const int smaller = this->expect_to_go_on_after({{Kind::loss, 0.3},
                                                   {Kind::reorder, 0.3},
                                                   {Kind::duplicate, 0.3},
                                                   {Kind::jitter, 0.004},
                                                   {Kind::slow_start, 0.05},
                                                   {Kind::half_message, 0.3},
                                                   {Kind::stall}});
  EXPECT_EQ(smaller, 0);
}

TYPED_TEST(ThreadedDatagrams, WhatIsNoiseIsNotTakenForGood) {
  this->expect_to_go_on_after({{Kind::garbage, 0.3},
                               {Kind::half_message, 0.3},
                               {Kind::reorder, 0.3},
                               {Kind::error_code, 13},
                               {Kind::saturate}});
}

TYPED_TEST(ThreadedDatagrams, SilenceIsTheEndOfTheLink) {
  for (const Trouble& trouble : {Trouble{Kind::stall}, Trouble{Kind::disconnect}, Trouble{Kind::loss, 1.0}}) {
    typename TestFixture::Place there(kImpatient);
    FaultyFakes fakes({there.server.get()});
    const auto driver = there.driver();
    typename TestFixture::WatchType watch(*driver);
    LoopThread loop(watch);
    loop.pass(20);
    fakes.suffer(*there.server, trouble);
    EXPECT_TRUE(comes_true([&] { return watch.lost(); })) << static_cast<int>(trouble.kind);
    fakes.heal(*there.server);
    loop.pass(20);
    loop.end();
    watch.expect_whole();
    EXPECT_FALSE(driver->linked());
  }
}

TYPED_TEST(ThreadedDatagrams, EndInEveryState) {
  enum class At { once, reading, stall, left_alone, gone };
  for (const At at : {At::once, At::reading, At::stall, At::left_alone, At::gone}) {
    typename TestFixture::Place there(kPatient);
    FaultyFakes fakes({there.server.get()});
    auto driver = there.driver();
    typename TestFixture::WatchType watch(*driver);
    if (at == At::once) continue;
    LoopThread loop(watch);
    loop.pass(15);
    if (at == At::stall) fakes.suffer(*there.server, {Kind::stall});
    if (at == At::left_alone || at == At::gone) fakes.end();
    if (at == At::gone) there.server.reset();
    loop.pass(5);
    loop.end();
    driver.reset();
    watch.expect_whole();
  }
}

// ---- The laboratory's whole rig in one loop, its three fakes on one thread, with random faults.

struct ThreadedRigs {
  ThreadedRigs(double patience, std::uint64_t seed)
      : there_gcs(patience, seed),
        there_netft(patience, seed + 1),
        there_igtl(patience, seed + 2, igtl::Transport{seed % 2 != 0}) {}
  void tick(Time now) {  // in the loop's order: read all devices, then command one
    sensor_watch.tick(now);
    tracker_watch.tick(now);
    machine_watch.tick(now);
  }
  void end(int role) {
    if (role == 0) machine.reset();
    if (role == 1) sensor.reset();
    if (role == 2) tracker.reset();
  }

  FaultyGcs there_gcs;
  FaultyNetft there_netft;
  FaultyIgtl there_igtl;
  std::array<Fake*, 3> servers{there_gcs.server.get(), there_netft.server.get(), there_igtl.server.get()};
  FaultyFakes fakes{{servers.begin(), servers.end()}};
  std::unique_ptr<Manipulator> machine = there_gcs.driver();
  std::unique_ptr<ForceSensor> sensor = there_netft.driver();
  std::unique_ptr<PoseTracker> tracker = there_igtl.driver();
  MachineWatch machine_watch{*machine};
  SensorWatch sensor_watch{*sensor};
  TrackerWatch tracker_watch{*tracker};
};

double drawn_value(Kind kind, double share) {
  constexpr double kLongest = 0.01;  // s
  constexpr int kCode = 504;
  if (kind == Kind::error_code) return kCode;
  return kind == Kind::jitter || kind == Kind::slow_start ? kLongest * share : share;
}

// Most faults cut off the machine, and then its thread is over: so they are drawn only now and then.
bool drawn_at_times(int role, Kind kind) { return role == 0 && kind != Kind::jitter && kind != Kind::stall; }

void suffer_and_end(const std::array<int, 3>& order, std::uint64_t seed) {
  ThreadedRigs rig(seed % 2 == 0 ? kPatient : kImpatient, seed);
  LoopThread loop(rig);
  std::mt19937_64 random(seed);
  const auto below = [&](std::uint64_t end) { return random() % end; };
  for (int faults = 0; faults < 40;) {
    const std::uint64_t role = below(3);
    const Kind kind = kAllTroubles[below(kAllTroubles.size())];
    const double share = 0.01 * static_cast<double>(below(100));
    Fake& fake = *rig.servers[role];
    const Trouble trouble{kind, drawn_value(kind, share)};
    if (!fake.knows(trouble) || (drawn_at_times(static_cast<int>(role), kind) && below(8) != 0)) continue;
    ++faults;
    rig.fakes.suffer(fake, trouble);
    loop.pass(4);
    if (below(4) != 0) rig.fakes.heal(fake, kind);
  }
  if (seed % 3 == 0)
    for (Fake* const fake : rig.servers) rig.fakes.heal(*fake);
  if (seed % 3 == 1) rig.fakes.end();
  loop.end();
  for (const int role : order) rig.end(role);
  rig.machine_watch.expect_whole();
  rig.sensor_watch.expect_whole();
  rig.tracker_watch.expect_whole();
  EXPECT_EQ(rig.tracker_watch.smaller, 0);
  EXPECT_GT(rig.machine_watch.ticks, 0);
}

TEST(ThreadedRig, SuffersWhatIsDrawnByLotAndEndsInEveryOrder) {
  std::array<int, 3> order{0, 1, 2};
  std::uint64_t seed = 1;
  do {
    SCOPED_TRACE(seed);
    suffer_and_end(order, seed++);
  } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace
}  // namespace enc::test
