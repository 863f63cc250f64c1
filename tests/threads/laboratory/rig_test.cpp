// The laboratory's whole rig in one loop, its three fakes on one thread, and what goes wrong is drawn by lot.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "tests/threads/laboratory/faulty_fakes.h"
#include "tests/threads/laboratory/loop_thread.h"
#include "tests/threads/laboratory/watches.h"

namespace enc::test {
namespace {

using Kind = Trouble::Kind;

struct ThreadedRigs {
  ThreadedRigs(double patience, std::uint64_t seed)
      : there_gcs(patience, seed),
        there_netft(patience, seed + 1),
        there_igtl(patience, seed + 2, igtl::Transport{seed % 2 != 0}) {}
  void tick(Time now) {  // in the loop's order: all are read, then one is told
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

// The machine is cut off by most of what it may meet, and then its thread is over: that is for once in a
// while.
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
