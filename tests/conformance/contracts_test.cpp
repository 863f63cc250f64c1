// The contract of each kind of device: manipulators, force sensors, trackers and grippers, simulated and
// real.
#include <chrono>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "sim/plants/tracker_plant.h"
#include "tests/conformance/gcs_bench.h"
#include "tests/support/built.h"
#include "tests/support/devices.h"
#include "tests/support/twin.h"

namespace enc::test {
namespace {

// ---- Every Manipulator: the simulated hexapod, the driver to copy and the drivers of devices. A new driver
// is one more entry of the table at the end.

// A device with its support and its clock.
struct Machine {
  virtual ~Machine() = default;
  virtual Manipulator& device() = 0;
  virtual void next() { now += Duration(1'000'000); }           // one cycle passes
  [[nodiscard]] virtual Duration oldest() const { return {}; }  // age of its measurements, behind its cycle
  Time now{-Duration(1'000'000)};
};

struct SimMachine final : Machine {
  explicit SimMachine(const std::vector<std::string>& set = {}) : twin(set) {}
  Twin twin;
  Manipulator& device() override { return *twin.rig.manipulator; }
  void next() override { now = twin.rig.clock->next().t; }
};

struct SampleMachine final : Machine {
  Reach reach{0.05, 0.41, Hexapod{HexapodGeometry{}}};
  DefaultOffer offer;
  std::unique_ptr<Manipulator> made = app::load_module("sample").driver->manipulator(offer.with(reach));
  Manipulator& device() override { return *made; }
};

// The driver of the C-887 and its fake over loopback, in wall time: half a millisecond is enough for a cycle
// of this test.
struct GcsMachine final : Machine {
  GcsPort there;
  std::unique_ptr<Manipulator> made = app::load_module("gcs").driver->manipulator(there.offer());
  Manipulator& device() override { return *made; }
  [[nodiscard]] Duration oldest() const override { return Duration(45'000'000); }
  void next() override {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    Machine::next();
  }
};

struct Entry {
  const char* name;
  std::unique_ptr<Machine> (*make)();
};

class ManipulatorTest : public testing::TestWithParam<Entry> {
 protected:
  void SetUp() override {
    setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
    machine_ = GetParam().make();
  }
  Measurement<TipSample> after(const Pose<'R', 'H'>& command, int cycles) {
    Measurement<TipSample> last;
    for (int i = 0; i < cycles; ++i) {
      machine_->next();
      last = machine_->device().read(machine_->now);
      machine_->device().command(command);
    }
    return last;
  }
  [[nodiscard]] Pose<'R', 'H'> zero() { return machine_->device().reach().machine.zero(); }
  [[nodiscard]] Pose<'R', 'H'> at(double x, double y, double z) {
    const Vec3 p = zero().p() + Vec3(x, y, z);
    return Pose<'R', 'H'>::shift(p.x(), p.y(), p.z());
  }
  std::unique_ptr<Machine> machine_;
};

TEST_P(ManipulatorTest, TimeNeverGoesBackAndAdvances) {
  Time before = Time{} - machine_->oldest();
  for (int i = 0; i < 50; ++i) {
    machine_->next();
    const auto s = machine_->device().read(machine_->now);
    EXPECT_GE(s.t, before);
    before = s.t;
  }
  EXPECT_LE(before, Time(Duration(49'000'000)));
  EXPECT_GE(before, Time(Duration(49'000'000)) - machine_->oldest());
}

TEST_P(ManipulatorTest, SaysAPoseThatIsOneAndWithinItsReach) {
  machine_->next();
  const auto s = machine_->device().read(machine_->now);
  EXPECT_EQ(s.health, Health::ok);
  EXPECT_TRUE(s.value.X_RH.valid());
  EXPECT_TRUE(machine_->device().reach().contains(s.value.X_RH));
  EXPECT_TRUE(s.value.velocity.finite());
  EXPECT_TRUE(s.value.acceleration.finite());
}

TEST_P(ManipulatorTest, GoesWhereItIsTold) {
  const Pose<'R', 'H'> there = at(0.004, -0.003, 0.002);
  const auto s = after(there, 1500);
  EXPECT_EQ(s.health, Health::ok);
  EXPECT_LT((s.value.X_RH.p() - there.p()).norm(), 3e-6);  // its step
}

TEST_P(ManipulatorTest, OutOfReachIsClampedAndSaid) {
  const auto s = after(at(0, 0, 0.5), 3000);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_LT(s.value.X_RH.p().z() - zero().p().z(), 0.05);
  EXPECT_GT(s.value.X_RH.p().z() - zero().p().z(),
            0.015);  // it went to its limit: the stroke is +/-24 mm
  // Steps of 3 um, rounded, may end 1.5 um beyond the limit.
  const Pose<'R', 'H'> inside(Quat(s.value.X_RH.q()), Vec3(s.value.X_RH.p() - Vec3(0, 0, 3e-6)));
  EXPECT_TRUE(machine_->device().reach().contains(inside));
  EXPECT_EQ(after(zero(), 3000).health, Health::ok);  // it recovers
}

TEST_P(ManipulatorTest, NotANumberIsRefusedAndSaid) {
  const Pose<'R', 'H'> there = at(0.002, 0, 0);
  after(there, 1000);
  Pose<'R', 'H'> bad = there;
  bad.xyz[1] = kUnset;
  auto s = after(bad, 200);
  EXPECT_EQ(s.health, Health::fault);
  EXPECT_LT((s.value.X_RH.p() - there.p()).norm(), 3e-6);  // stands in place
  s = after(Pose<'R', 'H'>(Quat(2, 0, 0, 0), Vec3(there.p())), 2);
  EXPECT_EQ(s.health, Health::fault);  // no rotation either
  EXPECT_EQ(after(there, 2).health, Health::ok);
}

// The machine stands where it stopped from any speed, a second stop changes nothing, and a command starts
// anew.
TEST_P(ManipulatorTest, StopsStaysAndStartsAnew) {
  const Vec3 there = after(at(0.01, 0, 0), 60).value.X_RH.p();  // under way
  machine_->device().stop();
  const auto rest = [&](int cycles) -> Vec3 {
    for (int i = 0; i < cycles; ++i) machine_->next();
    return machine_->device().read(machine_->now).value.X_RH.p();
  };
  const Vec3 stood = rest(1500);
  EXPECT_LT((stood - there).norm(), 0.003);  // the braking distance
  machine_->device().stop();
  EXPECT_LT((rest(300) - stood).norm(), 3e-6);
  EXPECT_LT((after(at(0.001, 0, 0), 1500).value.X_RH.p() - at(0.001, 0, 0).p()).norm(), 3e-6);
}

TEST_P(ManipulatorTest, ReadNeitherWaitsNorMovesAnything) {
  after(at(0.01, 0, 0), 30);
  const auto first = machine_->device().read(machine_->now);
  for (int i = 0; i < 1000; ++i) {
    const auto once = machine_->device().read(machine_->now), again = machine_->device().read(machine_->now);
    // A device in wall time may have reported its next place in between.
    EXPECT_TRUE(again.t > once.t || again.value.X_RH.xyz == once.value.X_RH.xyz);
  }
  EXPECT_GE(machine_->device().read(machine_->now).t, first.t);
}

INSTANTIATE_TEST_SUITE_P(
    All, ManipulatorTest,
    testing::Values(
        Entry{"sim", []() -> std::unique_ptr<Machine> { return std::make_unique<SimMachine>(); }},
        Entry{"sim_structural",
              []() -> std::unique_ptr<Machine> {
                return std::make_unique<SimMachine>(
                    std::vector<std::string>{"truth.hexapod.form=structural"});
              }},
        Entry{"sample", []() -> std::unique_ptr<Machine> { return std::make_unique<SampleMachine>(); }},
        Entry{"gcs", []() -> std::unique_ptr<Machine> { return std::make_unique<GcsMachine>(); }}),
    [](const auto& entry) { return std::string(entry.param.name); });

// The plant alone: limits of the moving part, which a driver's machine enforces by itself.
TEST(SimulatedMachine, KeepsSpeedAndAccelerationUnderWildCommands) {
  Twin twin;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> far(-0.03, 0.03);
  const Reach reach = twin.rig.manipulator->reach();
  const Vec3 zero = reach.machine.zero().p();
  Vec3 before = zero;
  Vec3 velocity = Vec3::Zero();
  double fastest = 0.0;
  double hardest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    twin.rig.clock->next();
    const Vec3 p = twin.rig.manipulator->read({}).value.X_RH.p();
    const Vec3 v = (p - before) / 1e-3;
    fastest = std::max(fastest, v.norm());
    hardest = std::max(hardest, (v - velocity).norm() / 1e-3);
    before = p;
    velocity = v;
    if (i % 37 == 0)
      twin.rig.manipulator->command(
          Pose<'R', 'H'>(Quat::Identity(), Vec3(zero + Vec3(far(random), far(random), far(random)))));
  }
  EXPECT_LE(fastest, reach.speed * (1 + 1e-6));
  EXPECT_LE(hardest, reach.acceleration * (1 + 1e-6));
  EXPECT_GT(hardest, 0.9 * reach.acceleration);  // the test does reach its limit
}

// ---- Every ForceSensor: the simulated one and the driver to copy.

constexpr double kQuantum = 0.025;          // N
constexpr double kWeight = 0.91 * 9.80665;  // N, of the mass behind the sensor

TEST(SimulatedForce, IsAbsentBeforeTheFirstTick) {
  Twin twin;
  EXPECT_EQ(twin.rig.force->read({}).health, Health::absent);
  twin.rig.clock->next();
  EXPECT_EQ(twin.rig.force->read({}).health, Health::ok);
}

TEST(SimulatedForce, IsStampedAtEachTick) {
  Twin twin;
  for (int i = 0; i < 100; ++i) {
    const Tick k = twin.rig.clock->next();
    EXPECT_EQ(twin.rig.force->read({}).t, k.t);
    EXPECT_EQ(twin.rig.force->read({}).t, k.t);  // reading does not advance anything
  }
}

TEST(SimulatedForce, ReadsTheWeightWithNothingTouching) {
  Twin twin(exact_force());
  for (int i = 0; i < 20; ++i) twin.rig.clock->next();
  const Wrench w = twin.rig.force->read({}).value;
  EXPECT_NEAR(w.force.xyz[0], 0.0, 1e-12);
  EXPECT_NEAR(w.force.xyz[1], 0.0, 1e-12);
  EXPECT_NEAR(w.force.xyz[2], -kWeight, kQuantum);  // F's z points up as W's
}

TEST(SimulatedForce, ReadsInSteps) {
  Twin twin;
  for (int i = 0; i < 500; ++i) {
    twin.rig.clock->next();
    for (const double f : twin.rig.force->read({}).value.force.xyz)
      EXPECT_NEAR(f / kQuantum, std::round(f / kQuantum), 1e-9);
  }
}

TEST(SimulatedForce, SaturatesAtItsRangeAndSaysSo) {
  std::vector<std::string> set = exact_force();
  set.emplace_back("truth.force.range_N=10");
  set.emplace_back("user.approach_mm_s=[50]");
  Twin twin(set);
  bool seen = false;
  for (int i = 0; i < 12'000; ++i) {
    twin.tick();
    const auto s = twin.rig.force->read({});
    for (const double f : s.value.force.xyz) EXPECT_LE(std::abs(f), 10.0 + 1e-12);
    // 10 N less the weight of 8.9 N leave about 1 N for the tool; clear of both ends, health must be right.
    const double pressed = -twin.world->truth().contact_force.xyz[2];
    if (pressed > 2.0) {
      EXPECT_EQ(s.health, Health::saturated);
      seen = true;
    }
    if (pressed < 0.1 && twin.world->truth().tip_acceleration.norm() < 0.1) {
      EXPECT_EQ(s.health, Health::ok);
    }
  }
  EXPECT_TRUE(seen);
}

TEST(SimulatedForce, NoiseIsWhatTheRigSays) {
  Twin twin({"truth.force.quantum_N=1e-9", "truth.force.drift_N_per_sqrt_s=0"});
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kSamples = 500;  // before the tool sets out
  for (int i = 0; i < kSamples; ++i) {
    twin.rig.clock->next();
    const double f = twin.rig.force->read({}).value.force.xyz[0];
    sum += f;
    squares += f * f;
  }
  const double n = kSamples;
  const double mean = sum / n;
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.0125, 0.0125 * 4 / std::sqrt(2.0 * n));  // 4 sigma
}

TEST(SampleForce, ReadsZeroAndStampsItWithTheCycle) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  DefaultOffer offer;
  const auto force = app::load_module("sample").driver->force(offer.with());
  for (int i = 0; i < 5; ++i) {
    const Time now(Duration(1'000'000LL * i));
    const auto s = force->read(now);
    EXPECT_EQ(s.health, Health::ok);
    EXPECT_EQ(s.t, now);
    EXPECT_EQ(s.value.force.norm(), 0.0);
    EXPECT_EQ(s.value.torque.norm(), 0.0);
  }
}

// ---- Every PoseTracker; so far the simulated one. Rates and delays must match the rig's ground truth.

struct Tally {
  int news = 0;
  double age = 0.0, longest_gap = 0.0;  // s
  bool backwards = false;
};

// Runs the clock and collects the samples. The core is left out: it costs time and does not affect the
// tracker.
Tally watch(Twin& twin, double duration) {
  Tally tally;
  Measurement<TrackedTool> sample;
  Time before{};
  Time arrived{};
  for (int i = 0; i < static_cast<int>(duration * 1e3); ++i) {
    const Tick k = twin.rig.clock->next();
    if (!twin.rig.tracker->poll({}, sample)) continue;
    tally.backwards = tally.backwards || sample.t <= before || sample.t > k.t;
    if (tally.news > 0) tally.longest_gap = std::max(tally.longest_gap, seconds(k.t - arrived));
    before = sample.t;
    arrived = k.t;
    tally.age += seconds(k.t - sample.t);
    ++tally.news;
  }
  return tally;
}

TEST(SimulatedTracker, SaysNothingBeforeItsFirstSample) {
  Twin twin;
  Measurement<TrackedTool> sample;
  twin.rig.clock->next();
  EXPECT_FALSE(twin.rig.tracker->poll({}, sample));
  EXPECT_EQ(sample.health, Health::absent);
}

TEST(SimulatedTracker, NewsIsToldOnceAndOtherwiseTheSampleIsLeftAlone) {
  Twin twin;
  Measurement<TrackedTool> sample;
  while (!twin.rig.tracker->poll({}, sample)) twin.rig.clock->next();
  const Time first = sample.t;
  sample.value.tool = 77;
  EXPECT_FALSE(twin.rig.tracker->poll({}, sample));
  EXPECT_EQ(sample.value.tool, 77);
  EXPECT_EQ(sample.t, first);
}

// The server at 100 Hz polls exposures at 120 Hz: 100 packets a second. The mean age at the core has these
// parts: 3.5 ms to the host, half an exposure period (4.17 ms) of wait in the server, 9.2 ms of its
// application, 0.5 ms of network, half a tick. (docs/notes/tracking.md)
TEST(SimulatedTracker, RateAndAgeAreThoseOfTheRig) {
  Twin twin;
  const Tally tally = watch(twin, 60.0);
  EXPECT_FALSE(tally.backwards);
  EXPECT_NEAR(tally.news / 60.0, 100.0, 2.0);
  const double expected = 3.5e-3 + 0.5 / 120.0 + 9.2e-3 + 0.5e-3 + 0.5e-3;
  EXPECT_NEAR(tally.age / tally.news, expected, 0.05 * expected);
}

// Packets that are sent when ready: every exposure arrives, without a wait for the server.
TEST(SimulatedTracker, PacketsByEventComeAtTheExposuresRateWithoutTheServersWait) {
  Twin twin({"truth.tracker.packets=event", "truth.tracker.server_rate_hz=1"});
  const Tally tally = watch(twin, 60.0);
  const sim::TrackerTruth& truth = twin.setup.twin.tracker;
  EXPECT_FALSE(tally.backwards);
  EXPECT_GT(tally.news / 60.0,
            110.0);  // out of 120: a packet that arrives late, or with the next one, is not news
  EXPECT_LE(tally.news / 60.0, 120.1);
  const double expected = truth.latency + truth.process + truth.udp_delay + 0.5e-3;
  EXPECT_NEAR(tally.age / tally.news, expected, 0.1 * expected);
}

TEST(SimulatedTracker, AStampErrorIsInTheStampsAndNowhereElse) {
  Twin right;
  Twin wrong({"truth.tracker.stamp_error_ms=3"});
  Measurement<TrackedTool> a;
  Measurement<TrackedTool> b;
  int news = 0;
  for (int i = 0; i < 1000; ++i) {
    right.rig.clock->next();
    wrong.rig.clock->next();
    const bool is_news = right.rig.tracker->poll({}, a);
    ASSERT_EQ(wrong.rig.tracker->poll({}, b), is_news);
    if (!is_news) continue;
    ++news;
    EXPECT_EQ(b.t - a.t, from_seconds(0.003));
    EXPECT_EQ(b.value.X_CT.xyz, a.value.X_CT.xyz);
  }
  EXPECT_GT(news, 90);
}

TEST(SimulatedTracker, BlackOutIsAsLongAsSaid) {
  Twin twin({"truth.tracker.blackout_at_s=1", "truth.tracker.blackout_for_s=0.2"});
  const Tally tally = watch(twin, 3.0);
  EXPECT_GT(tally.longest_gap, 0.18);
  EXPECT_LT(tally.longest_gap, 0.24);
}

TEST(SimulatedTracker, LosesItsShareOfPackets) {
  Twin twin({"truth.tracker.loss=0.3"});
  const Tally tally = watch(twin, 20.0);
  EXPECT_NEAR(tally.news / 20.0, 70.0, 4.0);  // 2,000 packets: 4 sigma is 4.1 a second
  EXPECT_NEAR(static_cast<double>(twin.world->tracker->state().dropped) / 2000.0, 0.3, 0.041);
}

TEST(SimulatedTracker, MeasuresTheToolWithBiasAndNoise) {
  Twin twin({"truth.hand.tremor_mm=0", "truth.hand.drift_mm=0"});
  Measurement<TrackedTool> sample;
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (int i = 0; i < 590; ++i) {  // before the tool sets out
    twin.rig.clock->next();
    if (!twin.rig.tracker->poll({}, sample)) continue;
    EXPECT_EQ(sample.value.tool, 0);
    const Pose<'W', 'T'> X_WT = twin.scene.X_WC * sample.value.X_CT;
    const Point<'W'> tip = X_WT * Point<'T'>(twin.setup.scene.tools[0].tip);
    sum += (tip - twin.world->truth().tool_tip).e();
    ++n;
  }
  ASSERT_GT(n, 40);
  const Vec3 bias = sum / n;
  const ToolSpec& tool = twin.setup.scene.tools[0];
  const sim::TrackerTruth truth = sim::with_tool_known(twin.setup.twin.tracker, tool.markers, tool.tip);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(bias(i), truth.bias(i), 4.0 * truth.noise(i) / std::sqrt(n)) << i;
}

TEST(SimulatedDisplay, ADentComesNoEarlierThanItsLatency) {
  Twin twin({"truth.display.latency_ms=25"});
  Measurement<DentSample> dent;
  twin.rig.clock->next();
  EXPECT_FALSE(twin.rig.display->poll({}, dent));
  EXPECT_EQ(dent.health, Health::absent);
  Time before{};
  int news = 0;
  for (int i = 0; i < 2000; ++i) {
    const Tick k = twin.rig.clock->next();
    View view;
    view.t = k.t;
    twin.rig.display->show(view);
    if (!twin.rig.display->poll({}, dent)) continue;
    EXPECT_GE(k.t - dent.t, from_seconds(0.025));
    EXPECT_LT(k.t - dent.t, from_seconds(0.027));  // no later than the tick after
    EXPECT_GT(dent.t, before);
    before = dent.t;
    ++news;
  }
  EXPECT_NEAR(news, 120, 3);  // 60 Hz
}

// ---- Every Gripper; so far the simulated one.

struct Gripping : testing::Test {
  Twin twin{{}, 1, "clamped_tool"};
  Gripper& device() { return *twin.rig.gripper; }
  Measurement<GripSample> after(const Grip& grip, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      twin.rig.clock->next();
      device().command(grip);
    }
    return device().read({});
  }
};

TEST_F(Gripping, IsAbsentBeforeTheFirstTickAndThenStampedAtEach) {
  EXPECT_EQ(device().read({}).health, Health::absent);
  for (int i = 0; i < 50; ++i) {
    const Tick k = twin.rig.clock->next();
    EXPECT_EQ(device().read({}).t, k.t);
    EXPECT_EQ(device().read({}).health, Health::ok);
    device().command({false, kUnset});
  }
}

TEST_F(Gripping, ClosesHoldsOpensAndSaysSo) {
  const auto closed = after({true, 100.0}, 400);
  EXPECT_EQ(closed.value.phase, GripPhase::closed);
  EXPECT_TRUE(closed.value.holding);
  EXPECT_DOUBLE_EQ(closed.value.force, 100.0);
  const auto open = after({false, kUnset}, 400);
  EXPECT_EQ(open.value.phase, GripPhase::open);
  EXPECT_FALSE(open.value.holding);
  EXPECT_EQ(open.value.force, 0.0);
  EXPECT_GT(open.value.opening, closed.value.opening);
}

TEST_F(Gripping, AForceOutsideItsRangeIsClampedAndSaid) {
  auto s = after({true, 1000.0}, 400);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_DOUBLE_EQ(s.value.force, 215.0);
  s = after({true, 1.0}, 2);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_DOUBLE_EQ(s.value.force, 54.0);
  EXPECT_EQ(after({true, 100.0}, 2).health, Health::ok);
}

TEST_F(Gripping, NotANumberIsRefusedAndTheGripKept) {
  after({true, 100.0}, 400);
  const auto s = after({true, kUnset}, 10);
  EXPECT_EQ(s.health, Health::fault);
  EXPECT_TRUE(s.value.holding);
  EXPECT_DOUBLE_EQ(s.value.force, 100.0);
  EXPECT_EQ(after({true, 100.0}, 2).health, Health::ok);
}

TEST_F(Gripping, StopKeepsWhatItHolds) {
  after({true, 100.0}, 400);
  for (int times = 0; times < 2; ++times) {
    device().stop();
    for (int i = 0; i < 300; ++i) twin.rig.clock->next();
    EXPECT_TRUE(device().read({}).value.holding);
    EXPECT_DOUBLE_EQ(device().read({}).value.force, 100.0);
  }
  EXPECT_FALSE(after({false, kUnset}, 400).value.holding);
}

TEST_F(Gripping, ReadingChangesNothing) {
  after({true, 100.0}, 30);
  const double opening = device().read({}).value.opening;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(device().read({}).value.opening, opening);
}

}  // namespace
}  // namespace enc::test
